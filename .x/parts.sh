# shellcheck shell=sh disable=SC2154
# Part of ./x: the native parts. Each setup_* looks for what the system has, gets it if there is
# none, and says to cargo (load_from, drivers, clang) and to doctor (part) where it is.

embreex=4.4.0.post1 # a PyPI wheel around Embree 4.4.0
embreex_sha256=2cd0f7d5c6342e6247e31f700761689cae7829454d8c6de0c41e62124a023e1f
libclang=18.1.1 # bindgen reads C headers with it
libclang_sha256=c533091d8a3bbf7460a00cb6c1a71da93bffe148f172c7d03b1c31fbf8aa2a0b
chromium=147.0.0 # an npm package that carries SwiftShader, a second software Vulkan driver
chromium_sha256=18fe5404ce845594cd7d592fc07f37a19514079ba4d9c27192ad8b908743f16b

# Where the dynamic linker finds a library of this machine's own word size.
system_library() { ldconfig -p 2>/dev/null | sed -n "s/^[[:space:]]*$1 (libc6,.*=> //p" | head -n1; }

links() {
    printf '#include <vector>\nint main(void) { return 0; }' >"$tmp/a.cc"
    printf 'int main(void) { return 0; }' >"$tmp/a.c" && try cc -o "$tmp/a" "$tmp/a.c" &&
        try c++ -o "$tmp/a" "$tmp/a.cc"
}
setup_cc() {
    have cc && have c++ && links && return
    if am_root && apt_update && try_apt install --no-install-recommends gcc g++ libc6-dev && links; then
        say "libc6-dev $(debian_version libc6-dev): installed (Debian), so that cc and c++ can link"
    else
        die "compilers of C and C++ that link are needed (Debian: gcc g++ libc6-dev): $why"
    fi
}

setup_embree() {
    lib=
    if [ -n "${EMBREE_DIR-}" ]; then
        cd "$here" || exit # EMBREE_DIR may be relative
        for dir in "$EMBREE_DIR" "$EMBREE_DIR/lib64" "$EMBREE_DIR/lib"; do
            [ ! -e "$dir/libembree4.so.4" ] || lib=$(cd "$dir" && pwd -P)/libembree4.so.4
        done
        cd "$root" || exit
        [ -n "$lib" ] || die "EMBREE_DIR=$EMBREE_DIR: libembree4.so.4 is neither in it nor in its lib"
    else
        lib=$(system_library libembree4.so.4)
    fi
    if [ -n "$lib" ]; then
        embree=$native/embree-system version=$(readlink -f "$lib") origin=$lib
        version=${version##*.so.}
        rm -rf "$embree"
        mkdir "$embree"
        ln -s "$lib" "$embree/libembree4.so" # the linker asks for this name
        load_from "${lib%/*}"
        say "Embree $version: $lib (this machine's own)"
    else
        embree=$native/embree-$embreex version=${embreex%.post*} origin=pypi:embreex-$embreex
        if [ ! -e "$embree/libembree4.so" ]; then
            obtain pypi embreex "$embreex" "$embreex_sha256" ||
                die "Embree $version from PyPI: $why; or install Embree 4 and set EMBREE_DIR"
            (cd "$tmp/out/embreex.libs" && ln -s libembree4-*.so.4 libembree4.so)
            place "$tmp/out/embreex.libs" "$embree"
            say "Embree $version: $embree (PyPI embreex $embreex)"
        fi
    fi
    load_from "$embree"
    part embree "$version" "$origin" "$embree/libembree4.so"
}

# Of the system's only versions that bindgen 0.68 is known to read right.
setup_libclang() {
    for version in 18 17 16 15 14; do
        clang=/usr/lib/llvm-$version/lib
        for lib in "$clang"/libclang.so* "$clang/libclang-$version.so"*; do
            [ ! -e "$lib" ] || { part libclang "$version" "$lib" "$lib" && return; }
        done
    done
    clang=$native/libclang-$libclang
    if [ ! -e "$clang/libclang.so" ]; then
        obtain pypi libclang "$libclang" "$libclang_sha256" || die "libclang $libclang from PyPI: $why"
        place "$tmp/out/libclang-$libclang.data/platlib/clang/native" "$clang"
        say "libclang $libclang: $clang (PyPI)"
    fi
    part libclang "$libclang" "pypi:libclang-$libclang" "$clang/libclang.so"
}

setup_swiftshader() {
    swiftshader=$native/swiftshader-$chromium
    if [ ! -e "$swiftshader/vk_swiftshader_icd.json" ]; then
        { obtain npm @sparticuz/chromium "$chromium" "$chromium_sha256" && unpack_swiftshader; } ||
            die "SwiftShader from npm: $why"
        place "$tmp/swiftshader" "$swiftshader"
        say "SwiftShader of Chromium $chromium: $swiftshader (npm @sparticuz/chromium)"
    fi
    drivers=$swiftshader/vk_swiftshader_icd.json${drivers:+:$drivers}
    part swiftshader "chromium-$chromium" "npm:@sparticuz/chromium-$chromium" \
        "$swiftshader/libvk_swiftshader.so"
}
# Its EGL stays out, where GL would find it; its loader stays apart, for those who have none.
unpack_swiftshader() {
    mkdir -p "$tmp/swiftshader/loader"
    try node -e 'const fs = require("fs"), [from, to] = process.argv.slice(1);
        fs.writeFileSync(to, require("zlib").brotliDecompressSync(fs.readFileSync(from)))' \
        "$tmp/out/package/bin/swiftshader.tar.br" "$tmp/tar" &&
        try tar -xf "$tmp/tar" -C "$tmp/swiftshader" --no-same-owner --exclude='lib*GL*' &&
        mv "$tmp/swiftshader/libvulkan.so.1" "$tmp/swiftshader/loader/"
}

# A loader older than 1.3.207 would ignore the drivers that we add.
system_loader() {
    loader=$(system_library libvulkan.so.1)
    [ -n "$loader" ] && grep -q VK_ADD_DRIVER_FILES "$loader"
}
system_lavapipe() {
    for icd in /etc/vulkan/icd.d/lvp_icd* /usr/local/share/vulkan/icd.d/lvp_icd* \
        /usr/share/vulkan/icd.d/lvp_icd*; do
        [ ! -e "$icd" ] || return 0
    done
    return 1
}

setup_vulkan() {
    mesa=$native/mesa
    if ! system_lavapipe && [ ! -e "$mesa/lvp_icd.json" ]; then install_lavapipe; fi
    if system_lavapipe; then
        part lavapipe "$(debian_version mesa-vulkan-drivers)" "$icd" "$icd"
    elif [ -e "$mesa/lvp_icd.json" ]; then
        for dir in "$mesa/usr/lib"/*-linux-gnu; do load_from "$dir"; done
        drivers=${drivers:+$drivers:}$mesa/lvp_icd.json
        part lavapipe "$(cat "$mesa/version")" deb:mesa-vulkan-drivers "$mesa/lvp_icd.json"
    else
        part lavapipe missing deb:mesa-vulkan-drivers
    fi
    if system_loader; then
        part vulkan-loader "$(debian_version libvulkan1)" "$loader" "$loader"
    else
        load_from "$swiftshader/loader"
        part vulkan-loader "chromium-$chromium" npm:@sparticuz/chromium "$swiftshader/loader/libvulkan.so.1"
    fi
}

install_lavapipe() {
    if ! have apt-get; then
        say "lavapipe: $why; to compare on it too, install Mesa's Vulkan drivers and run ./x setup"
    elif am_root; then
        { apt_update && try_apt install --no-install-recommends mesa-vulkan-drivers; } ||
            die "lavapipe from Debian: $why"
        say "lavapipe $(debian_version mesa-vulkan-drivers): installed (Debian mesa-vulkan-drivers)"
    else
        unpack_mesa || die "lavapipe from Debian: $why"
        say "lavapipe $(cat "$mesa/version"): $mesa (Debian mesa-vulkan-drivers)"
    fi
}

# Without root: Mesa and all it needs that the system lacks, unpacked into a folder.
unpack_mesa() {
    apt_update && try_apt install --download-only --no-install-recommends mesa-vulkan-drivers || return 1
    mkdir "$tmp/mesa"
    for deb in "$tmp/apt/archives"/*.deb; do
        case ${deb##*/} in libc6_*) continue ;; esac # a process must have the system's, only
        try dpkg -x "$deb" "$tmp/mesa" || return 1
    done
    dpkg-deb -f "$tmp/apt/archives"/mesa-vulkan-drivers_*.deb Version >"$tmp/mesa/version"
    [ ! -d "$tmp/mesa/lib" ] || cp -a "$tmp/mesa/lib" "$tmp/mesa/usr/"
    rm -f "$tmp/mesa"/usr/lib/*/libvulkan.so* # the loader is chosen elsewhere
    for libs in "$tmp/mesa/usr/lib"/*-linux-gnu; do libs=${libs##*/}; done
    ln -s "$libs" "$tmp/mesa/usr/lib/lib" # LLVM looks for its own libraries in ../lib, only
    lavapipe=$mesa/usr/lib/$libs/libvulkan_lvp.so
    sed "s|\(\"library_path\": \"\)[^\"]*|\1$lavapipe|" "$tmp/mesa"/usr/share/vulkan/icd.d/lvp_icd*.json \
        >"$tmp/mesa/lvp_icd.json"
    place "$tmp/mesa" "$mesa"
    loads "$lavapipe" "${lavapipe%/*}" || { rm -rf "$mesa" && return 1; }
}

# loads LIBRARY FOLDER: whether a program that cargo links would find all that the library needs.
loads() {
    cat >"$tmp/a.c" <<'END'
#include <dlfcn.h>
#include <stdio.h>
int main(int n, char **path) { return n && dlopen(path[1], RTLD_NOW) ? 0 : !!puts(dlerror()); }
END
    try cc -o "$tmp/a" "$tmp/a.c" "-Wl,--disable-new-dtags,-rpath,$2" -ldl && try "$tmp/a" "$1"
}

#!/usr/bin/env bash
# The same bits on aarch64: builds the determinism suite and the program for it, runs them
# under QEMU's user emulation and compares what they leave with what this machine leaves.
# Needs root on Debian (compiler for aarch64, emulator, Rust's library for it, which Debian
# has beside its own compiler of the same version); 15 to 25 minutes on two cores.
#
#   .ci/second_isa.sh [FOLDER]     FOLDER keeps compilers and build, 3 GB
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$(realpath -m "${1:-$root/target/second-isa}")
mkdir -p "$folder"
triple=aarch64-unknown-linux-gnu

say() { printf '\n== %s\n' "$*"; }

say "tools"
apt-get update -qq
apt-get install -qq -y --no-install-recommends qemu-user-static gcc-aarch64-linux-gnu \
    libc6-dev-arm64-cross >/dev/null

# A compiler with libraries for both, unpacked beside the installed one: Debian's packages
# of it conflict with rustup's. Lists of its own, since only they name arm64's packages.
say "Rust with libraries for both"
apt_root=$folder/apt
mkdir -p "$apt_root"/{state/lists/partial,cache/archives/partial,dpkg}
touch "$apt_root/dpkg/status"
own=(-o "Dir::State=$apt_root/state" -o "Dir::Cache=$apt_root/cache"
    -o "Dir::State::status=$apt_root/dpkg/status"
    -o APT::Architecture=amd64 -o APT::Architectures=amd64,arm64)
apt-get "${own[@]}" update -qq
rm -f "$apt_root"/*.deb
newest() { apt-cache "${own[@]}" policy "$1" | awk '/Candidate:/ { print $2 }'; }
version=$(newest rustc-web:amd64)
short=$(printf '%s' "$version" | cut -d. -f1-2)
llvm=$(apt-cache "${own[@]}" show "libstd-rust-web-$short:amd64=$version" 2>/dev/null |
    grep -o 'libllvm[0-9]*' | head -1)
(cd "$apt_root" && apt-get "${own[@]}" download -qq "rustc-web:amd64=$version" \
    "libstd-rust-web-dev:amd64=$version" "libstd-rust-web-$short:amd64=$version" \
    "${llvm:-libllvm22}:amd64" "libstd-rust-web-dev:arm64=$version")
sysroot=$folder/rust
rm -rf "$sysroot"
mkdir -p "$sysroot"
for package in "$apt_root"/*.deb; do dpkg -x "$package" "$sysroot"; done
cat >"$folder/rustc" <<EOF
#!/bin/sh
LD_LIBRARY_PATH=$sysroot/usr/lib/x86_64-linux-gnu exec $sysroot/usr/bin/rustc --sysroot $sysroot/usr "\$@"
EOF
chmod +x "$folder/rustc"
"$folder/rustc" --version

say "build for this machine and for aarch64"
cd "$root"
build=(cargo build --release --workspace --bin gnomon --test determinism
    --message-format=json-render-diagnostics)
"${build[@]}" >"$folder/native.json"
RUSTC=$folder/rustc CARGO_TARGET_DIR=$folder/target \
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
    CC_aarch64_unknown_linux_gnu=aarch64-linux-gnu-gcc \
    "${build[@]}" --target $triple >"$folder/foreign.json"
artifact() { # KIND NAME: the executable in a build's messages
    python3 -c '
import json, sys
kind, name = sys.argv[1:]
for line in sys.stdin:
    m = json.loads(line) if line.startswith("{") else {}
    t = m.get("target", {})
    if m.get("executable") and t.get("name") == name and kind in t["kind"]:
        print(m["executable"])' "$@"
}

run() { # foreign|native COMMAND...
    case $1 in
        foreign) shift && qemu-aarch64-static -L /usr/aarch64-linux-gnu "$@" ;;
        native) shift && "$@" ;;
    esac
}

say "digests of all that the determinism suite renders"
rm -f "$folder/native.digest" "$folder/foreign.digest"
for side in native foreign; do
    test=$(artifact test determinism <"$folder/$side.json")
    GNOMON_DIGEST_FILE=$folder/$side.digest run $side "$test" --test-threads 2 2>&1 | tail -3
done
wc -l <"$folder/native.digest"
diff "$folder/native.digest" "$folder/foreign.digest"

say "one frame of each technique"
different=0
rm -rf "$folder/native" "$folder/foreign"
program=$(artifact bin gnomon <"$folder/native.json")
mapfile -t techniques < <("$program" techniques --json |
    python3 -c 'import json, sys; [print(t["name"]) for t in json.load(sys.stdin)["techniques"]]')
[ ${#techniques[@]} -gt 0 ] || { echo "the program lists no techniques" && exit 1; }
for technique in "${techniques[@]}"; do
    for side in native foreign; do
        program=$(artifact bin gnomon <"$folder/$side.json")
        mkdir -p "$folder/$side"
        run $side "$program" render creature --technique "$technique" --size 96x64 --threads 2 \
            --quiet --out "$folder/$side/$technique.png" --visibility "$folder/$side/$technique.npy" \
            >/dev/null 2>"$folder/$side/$technique.txt" && code=0 || code=$?
        echo "$code" >"$folder/$side/$technique.code"
        # It may refuse the scene in so many words; those of both sides are compared below.
        if [ "$code" = 2 ] && grep -q "^error: technique '$technique' " "$folder/$side/$technique.txt"; then
            echo "$technique refuses, $side: $(tail -1 "$folder/$side/$technique.txt")"
        elif [ ! -s "$folder/$side/$technique.png" ]; then
            echo "$technique drew nothing, $side: $(tail -1 "$folder/$side/$technique.txt")"
            different=1
        fi
    done
    for kind in png npy txt code; do
        a=$folder/native/$technique.$kind b=$folder/foreign/$technique.$kind
        if [ -e "$a" ] || [ -e "$b" ]; then
            cmp -s "$a" "$b" || { echo "$technique.$kind differs" && different=1; }
        fi
    done
done
echo "${#techniques[@]} techniques, $(ls "$folder"/native/*.png | wc -l) pictures"
[ $different = 0 ] && echo "the same bits on x86-64 and aarch64"
exit $different

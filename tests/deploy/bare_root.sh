# A bare Debian or Ubuntu root for the tests of packages; sourced. Needs root and debootstrap.
# shellcheck shell=bash
# $JAYWALK_ROOTS: a folder that keeps bare roots for the next time.

skip() {
  echo "skipped: $1"
  exit 77
}
fail() {
  echo "FAILED: $*"
  exit 1
}
[ "$(id -u)" = 0 ] || skip "chroot wants root"
command -v debootstrap >/dev/null || skip "no debootstrap"
scratch=$(mktemp -d)
root=$scratch/root
# What runs arm64 programs here, for as long as the test takes: the kernel starts them by way of qemu.
readonly kBinfmt=/proc/sys/fs/binfmt_misc
run_arm64() {
  local emulator magic='\x7fELF\x02\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\xb7\x00'
  local mask='\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff'
  emulator=$(command -v qemu-aarch64-static) || skip "no qemu-aarch64-static (package qemu-user-static)"
  [ -e "$kBinfmt/register" ] || mount -t binfmt_misc binfmt_misc "$kBinfmt" 2>/dev/null || skip "a kernel without binfmt_misc"
  [ -e "$kBinfmt/jaywalk-arm64-$$" ] || echo ":jaywalk-arm64-$$:M::$magic:$mask:$emulator:F" >"$kBinfmt/register"
}
leave_chroot() { umount -l "$root/proc" "$root/dev" 2>/dev/null || true; }
leave_root() {
  leave_chroot
  [ ! -e "$kBinfmt/jaywalk-arm64-$$" ] || echo -1 >"$kBinfmt/jaywalk-arm64-$$"
  rm -rf "$scratch"
}
trap leave_root EXIT

# bare_root SUITE ARCHITECTURE: unpacked in $root, /proc and /dev in place.
bare_root() {
  local kept=${JAYWALK_ROOTS:-$scratch}/$1-$2.tar mirror=http://deb.debian.org/debian
  [ "$1" != jammy ] || mirror=http://archive.ubuntu.com/ubuntu
  [ "$2" != arm64 ] || [ "$(dpkg --print-architecture)" = arm64 ] || run_arm64
  if [ ! -e "$kept" ]; then
    debootstrap --variant=minbase --arch="$2" "$1" "$root" "$mirror" >"$scratch/log" 2>&1 || {
      tail -5 "$scratch/log"
      skip "no bare root of $1 for $2 here"
    }
    [ "$1" != jammy ] || echo "deb $mirror jammy main universe" >"$root/etc/apt/sources.list"
    tar -C "$root" -cf "$kept" .
  else
    mkdir -p "$root" && tar -C "$root" -xf "$kept"
  fi
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
}
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C DEBIAN_FRONTEND=noninteractive "$@"; }
# install PACKAGES...
install() { inside apt-get install -y -qq --no-install-recommends "$@" >"$scratch/log" 2>&1 || { tail -5 "$scratch/log"; fail "apt-get install $*"; }; }

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
leave_chroot() { umount -l "$root/proc" "$root/dev" 2>/dev/null || true; }
leave_root() {
  leave_chroot
  rm -rf "$scratch"
}
trap leave_root EXIT

# bare_root SUITE ARCHITECTURE: unpacked in $root, /proc and /dev in place.
bare_root() {
  local kept=${JAYWALK_ROOTS:-$scratch}/$1-$2.tar mirror=http://deb.debian.org/debian
  [ "$1" != jammy ] || mirror=http://archive.ubuntu.com/ubuntu
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

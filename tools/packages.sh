# shellcheck shell=bash
# What the build needs from the system, and how it gets there; sourced by the other scripts.

# Names hold for Debian 12 and Ubuntu 22.04 and 24.04.
readonly kLibraries=(catch2 fonts-dejavu-core libboost-dev libbz2-dev libcairo2-dev libcli11-dev libeigen3-dev liblz4-dev libpng-dev libsqlite3-dev libssl-dev
  libtoml11-dev libyaml-cpp-dev libzstd-dev nlohmann-json3-dev zlib1g-dev)

# missing_packages: the Debian packages that are not there, one a line. A program counts wherever it came from.
missing_packages() {
  local library compiler=${CXX:-g++}
  command -v "${CXX:-c++}" >/dev/null || echo "${compiler/clang++/clang}"
  command -v cmake >/dev/null || echo cmake
  command -v ninja >/dev/null || command -v make >/dev/null || echo ninja-build
  command -v pkg-config >/dev/null || echo pkg-config
  command -v ccache >/dev/null || echo ccache # these two for the time of a build
  command -v mold >/dev/null || echo mold
  command -v ip >/dev/null || echo iproute2 # for the tests over wires
  command -v file >/dev/null || echo file # these two for packages
  command -v dpkg-shlibdeps >/dev/null || echo dpkg-dev
  for library in "${kLibraries[@]}"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$library" 2>/dev/null)" = installed ] || echo "$library"
  done
}

# install_missing: asks apt for what is not there, and for nothing when all is; says what.
install_missing() {
  local -a missing as_root=()
  if ! command -v dpkg-query >/dev/null; then
    echo "packages: this is not Debian or Ubuntu; it must have a C++20 compiler, cmake 3.22, ninja or make, and what Debian calls: ${kLibraries[*]}"
    return
  fi
  read -r -a missing <<<"$(missing_packages | tr '\n' ' ')"
  [ ${#missing[@]} -gt 0 ] || return 0
  echo "packages: installing what is missing: ${missing[*]}"
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  export DEBIAN_FRONTEND=noninteractive
  if ! { "${as_root[@]}" apt-get update -qq && "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null; }; then
    echo "packages: could not install; with a network and root, this does it: apt-get install ${missing[*]}" >&2
    return 1
  fi
}

# own_apt ARCH FOLDER: apt-get works for that architecture in FOLDER/apt from here on; this machine's packages and
# architectures stay as they are.
own_apt() {
  mkdir -p "$2"/apt/{state/lists/partial,cache/archives/partial}
  touch "$2/apt/status"
  cat >"$2/apt/apt.conf" <<C
APT::Architecture "$1";
APT::Architectures { "$1"; };
APT::Install-Recommends "false";
Dir::State "$2/apt/state";
Dir::State::status "$2/apt/status";
Dir::Cache "$2/apt/cache";
C
  export APT_CONFIG=$2/apt/apt.conf
  apt-get update -qq
}

# unpack_own FOLDER TREE: unpacks what own_apt's apt-get got into TREE.
unpack_own() {
  local package
  for package in "$1"/apt/cache/archives/*.deb; do dpkg -x "$package" "$2"; done
  rm -r "$1/apt"
}

# choose_tools: Ninja and ccache where they are, one compiler for C++ and nvcc; CMake reads these when it makes a new build folder.
choose_tools() {
  ! command -v ninja >/dev/null || export CMAKE_GENERATOR=Ninja
  ! command -v ccache >/dev/null || export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  [ -z "${CXX:-}" ] || export CUDAHOSTCXX=${CUDAHOSTCXX:-$CXX}
}

# build_release TARGET: the -O2 build in build/, the product's sources twelve at a time: a third of the processor's time.
build_release() {
  choose_tools
  cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12
  cmake --build build --parallel "$(nproc)" --target "$1"
}

# SPDX-License-Identifier: GPL-2.0-or-later
# Sourced by cases/run and tests/run; $root is the checkout.

# What building and running needs. libopenblas: without it apt brings the slow reference BLAS.
flank_packages=(g++ cmake ninja-build ccache pkg-config git libdeal.ii-dev libgmsh-dev libeigen3-dev
                libboost-dev zlib1g-dev libopenblas-dev libopenblas0-pthread openmpi-bin libcli11-dev
                libtomlplusplus-dev libspdlog-dev libfmt-dev)

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# flank_install PACKAGE...: installs those that are not there.
flank_install() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    if command -v cmake >/dev/null && [[ -n ${FLANK_ASSUME_INSTALLED:-} ]]; then return; fi
    echo "This is not a Debian system. Needed are (Debian 12's names): $*" >&2
    echo "Install their equivalents and set FLANK_ASSUME_INSTALLED=1." >&2
    exit 1
  fi
  local missing=() package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      missing+=("$package")
  done
  [[ ${#missing[@]} -eq 0 ]] && return
  local as_root=()
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null ||
      { echo "These packages are missing, install them as root: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
    --no-install-recommends "${missing[@]}" >/dev/null
}

# flank_build TYPE TARGET [CMAKE_OPTION=VALUE]...: configures where that is new, and builds.
# In build/ a folder of the type's name, or $flank_folder.
flank_build() {
  local type=$1 target=$2 folder=$root/build/${flank_folder:-${1,,}} option options=() new=
  shift 2
  # Eight files at a time: headers take most of the time. (clang++'s sanitizers compile each alone.)
  [[ "$*" == *CMAKE_UNITY_BUILD=* ]] || set -- CMAKE_UNITY_BUILD=ON CMAKE_UNITY_BUILD_BATCH_SIZE=8 "$@"
  [[ -f $folder/build.ninja ]] || new=yes
  for option in "$@"; do
    options+=("-D$option")
    grep -qs "^${option%%=*}:[A-Z]*=${option#*=}$" "$folder/CMakeCache.txt" || new=yes
  done
  if [[ -n $new ]]; then
    echo "configuring ${flank_folder:-$type}"
    mkdir -p "$folder"
    cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE="$type" "${options[@]}" \
        >"$folder/configure.log" 2>&1 ||
      { cat "$folder/configure.log" >&2; exit 1; }
  fi
  # The revision is looked up at every build; "building" is said only where something is compiled or linked.
  ninja -C "$folder" "$target" | tee "$folder/build.log" |
    awk -v type="${flank_folder:-$type}" \
      '/Building|Linking/ && !said { print "building " type; said = 1; fflush() }' ||
    { tail -60 "$folder/build.log" >&2; exit 1; }
}

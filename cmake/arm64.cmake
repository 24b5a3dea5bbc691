# Cross-building for arm64 on Debian, with Debian's libraries of that architecture (preset package-arm64). What the build
# itself runs, `cm1e --describe`, runs under qemu.
#   dpkg --add-architecture arm64 && apt-get update
#   apt-get install crossbuild-essential-arm64 qemu-user-static libcyaml-dev:arm64 libxml2-dev:arm64 ...
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
set(CM1E_PACKAGE_ARCHITECTURE arm64)
# Where Debian has libraries of an architecture; CMake chooses that folder only where it does not build cross.
set(CMAKE_INSTALL_LIBDIR lib/aarch64-linux-gnu CACHE STRING "Libraries")

# SPDX-License-Identifier: Apache-2.0
# Debian's cross compiler on a sysroot of Debian's libraries, as toolchain/sysroot makes it; the programs run through
# qemu-user. For a board's own sysroot use -DCMAKE_SYSROOT=FOLDER.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_CXX_COMPILER ${RELIEVO_TRIPLET}-g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${RELIEVO_TRIPLET})
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES CMAKE_SYSROOT)
if(NOT CMAKE_SYSROOT)
  get_filename_component(CMAKE_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../../build-check/sysroot/${RELIEVO_DEBIAN_ARCH} ABSOLUTE)
endif()
if(NOT EXISTS ${CMAKE_SYSROOT}/usr/lib)
  message(FATAL_ERROR "${CMAKE_SYSROOT} is no sysroot; run toolchain/sysroot ${RELIEVO_DEBIAN_ARCH}")
endif()

# Programs come from this machine, everything else from the sysroot.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${CMAKE_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${CMAKE_SYSROOT}/usr/lib/${RELIEVO_TRIPLET}/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig)

set(CMAKE_CROSSCOMPILING_EMULATOR qemu-${CMAKE_SYSTEM_PROCESSOR}-static;-L;${CMAKE_SYSROOT})

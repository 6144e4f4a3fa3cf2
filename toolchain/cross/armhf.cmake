# SPDX-License-Identifier: Apache-2.0
# ARMv7 with hardware floating point. Debian's compiler targets the oldest such processor; for a newer one add for example
# -DCMAKE_CXX_FLAGS=-mfpu=neon-vfpv4.
set(CMAKE_SYSTEM_PROCESSOR arm)
set(RELIEVO_DEBIAN_ARCH armhf)
set(RELIEVO_TRIPLET arm-linux-gnueabihf)
include(${CMAKE_CURRENT_LIST_DIR}/debian.cmake)

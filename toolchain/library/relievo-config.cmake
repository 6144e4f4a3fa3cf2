# SPDX-License-Identifier: Apache-2.0
# find_package(relievo 0.1): relievo::hal, relievo::platform and, where GoogleTest is installed, relievo::contract.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(glm)
include(${CMAKE_CURRENT_LIST_DIR}/relievo-targets.cmake)

find_package(GTest QUIET)
if(GTest_FOUND AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/relievo-contract.cmake)
  include(${CMAKE_CURRENT_LIST_DIR}/relievo-contract.cmake)
  set(relievo_contract_FOUND TRUE)
else()
  set(relievo_NOT_FOUND_MESSAGE "relievo::contract needs GoogleTest here, and relievo built with -DRELIEVO_TESTS=ON")
endif()
check_required_components(relievo)

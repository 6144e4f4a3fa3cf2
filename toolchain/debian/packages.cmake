# SPDX-License-Identifier: Apache-2.0
# One Debian package for each program, and one of librelievo (toolchain/library). Compressed files contain no timestamps, so that equal sources give equal packages.
set(RELIEVO_MAINTAINER "relievo maintainers <maintainers@relievo.invalid>" CACHE STRING "Who stands behind the packages")
set(made ${CMAKE_CURRENT_BINARY_DIR}/debian)
configure_file(debian/changelog.in ${made}/changelog @ONLY)
execute_process(COMMAND gzip -9nkf ${made}/changelog)
execute_process(COMMAND gzip -9nc ${CMAKE_CURRENT_SOURCE_DIR}/manual/relievo.toml.5 OUTPUT_FILE ${made}/relievo.toml.5.gz)
install(FILES ${made}/relievo.toml.5.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man5 COMPONENT relievo)
foreach(program ${programs})
  install(FILES debian/copyright ${made}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${program} COMPONENT ${program})
endforeach()
install(FILES debian/copyright ${made}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/librelievo-dev COMPONENT hal EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME relievo)
set(CPACK_PACKAGE_CONTACT "${RELIEVO_MAINTAINER}")
set(CPACK_COMPONENTS_ALL ${programs} hal)
set(CPACK_STRIP_FILES ON)
set(CPACK_SET_DESTDIR ON)  # for the one absolute path
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION video)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_RELIEVO_PACKAGE_NAME relievo)
set(CPACK_COMPONENT_RELIEVO_DESCRIPTION "player of 3D video that can be touched
relievo plays colour + depth video in stereo 3D, and a viewer holding a
force-feedback device feels the shapes in the picture while they move. This is
the player of a set-top box, with the service that starts it.")
set(CPACK_DEBIAN_RELIEVO_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers")
set(CPACK_DEBIAN_RELIEVO_PACKAGE_RECOMMENDS "libgl1-mesa-dri")
set(CPACK_DEBIAN_RELIEVO_PACKAGE_SUGGESTS "relievo-author, fonts-noto-cjk, xfonts-base | zenity")  # SDL's message box
set(CPACK_DEBIAN_RELIEVO_PACKAGE_CONTROL_EXTRA
    debian/relievo/conffiles debian/relievo/postinst debian/relievo/prerm debian/relievo/postrm)
list(TRANSFORM CPACK_DEBIAN_RELIEVO_PACKAGE_CONTROL_EXTRA PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
set(CPACK_DEBIAN_RELIEVO_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_RELIEVO-AUTHOR_PACKAGE_NAME relievo-author)
set(CPACK_COMPONENT_RELIEVO-AUTHOR_DESCRIPTION "maker of 3D video that can be touched
relievo-author packages the colour and depth of a camera or a renderer as
one film for relievo, and removes noise and holes from the depth.")

set(CPACK_DEBIAN_RELIEVO-LAB_PACKAGE_NAME relievo-lab)
set(CPACK_COMPONENT_RELIEVO-LAB_DESCRIPTION "measurements of touch on moving depth
relievo-lab measures the methods by which relievo makes depth video felt:
speed against accuracy, smoothness, stability, detail and bit rate, each as a
chart with its figures.")
set(CPACK_DEBIAN_RELIEVO-LAB_PACKAGE_DEPENDS "gnuplot-nox | gnuplot")
set(CPACK_DEBIAN_RELIEVO-LAB_PACKAGE_RECOMMENDS "libgl1-mesa-dri")

set(CPACK_DEBIAN_HAL_PACKAGE_NAME librelievo-dev)
set(CPACK_DEBIAN_HAL_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_HAL_DESCRIPTION "drivers for relievo outside of its tree
The interfaces of relievo's hardware abstraction layer as headers, static
libraries and a package of CMake, with the contract suites that a driver of a
haptic device, a display, a decoder or a source has to pass.")
set(CPACK_DEBIAN_HAL_PACKAGE_DEPENDS "libglm-dev")
set(CPACK_DEBIAN_HAL_PACKAGE_RECOMMENDS "cmake, g++, libgmock-dev")
set(CPACK_DEBIAN_HAL_PACKAGE_SHLIBDEPS OFF)
include(CPack)

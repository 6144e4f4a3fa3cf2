# SPDX-License-Identifier: Apache-2.0
SUMMARY = "Player of 3D video that can be touched"
DESCRIPTION = "relievo plays colour + depth video in stereo 3D, and a viewer \
holding a force-feedback device feels the shapes in the picture while they \
move. This is the player, with its service, configuration and udev rules."
SECTION = "multimedia"
LICENSE = "Apache-2.0"
LIC_FILES_CHKSUM = "file://LICENSE;md5=3b83ef96387f14655fc854ddc3c6bd57"
# As FFmpeg, which this links.
LICENSE_FLAGS = "commercial"
PV = "0.1.0"

DEPENDS = "alsa-lib cli11 ffmpeg glm libass libdrm libevdev libsdl2 libusb1 \
           nlohmann-json tiff tomlplusplus virtual/egl virtual/libgbm virtual/libgles2 zlib"

inherit cmake externalsrc features_check pkgconfig systemd useradd

# The tree that this layer is part of.
EXTERNALSRC = "${@os.path.realpath(os.path.join(d.getVar('THISDIR'), '../../../../..'))}"

REQUIRED_DISTRO_FEATURES = "opengl"

PACKAGECONFIG ??= "rosbag openni scan"
PACKAGECONFIG[gstreamer] = "-DRELIEVO_GSTREAMER=ON,-DRELIEVO_GSTREAMER=OFF,gstreamer1.0 gstreamer1.0-plugins-base"
PACKAGECONFIG[rosbag] = "-DRELIEVO_ROSBAG=ON,-DRELIEVO_ROSBAG=OFF,bzip2 lz4 sqlite3 zstd"
PACKAGECONFIG[heif] = "-DRELIEVO_HEIF=ON,-DRELIEVO_HEIF=OFF,libheif"
PACKAGECONFIG[openni] = "-DRELIEVO_OPENNI=ON,-DRELIEVO_OPENNI=OFF"
PACKAGECONFIG[scan] = "-DRELIEVO_SCAN=ON,-DRELIEVO_SCAN=OFF,lz4"
PACKAGECONFIG[stereo-play] = "-DRELIEVO_STEREO_PLAY=ON,-DRELIEVO_STEREO_PLAY=OFF"
EXTRA_OECMAKE = "-DRELIEVO_DESK=OFF -DRELIEVO_TESTS=OFF -DRELIEVO_EXR=OFF"

SYSTEMD_SERVICE:${PN} = "relievo.service"
SYSTEMD_AUTO_ENABLE = "enable"

USERADD_PACKAGES = "${PN}"
GROUPADD_PARAM:${PN} = "--system plugdev; --system relievo"
USERADD_PARAM:${PN} = "--system --no-create-home --home-dir /var/lib/relievo --shell /sbin/nologin --gid relievo relievo"

FILES:${PN} += "${nonarch_libdir}/systemd ${nonarch_libdir}/sysusers.d ${nonarch_libdir}/udev ${datadir}"
CONFFILES:${PN} = "${sysconfdir}/relievo/relievo.toml"
RRECOMMENDS:${PN} = "ttf-dejavu-sans"

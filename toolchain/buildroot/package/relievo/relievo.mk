################################################################################
#
# relievo
#
################################################################################

# The tree that this folder is part of.
RELIEVO_VERSION = 0.1.0
RELIEVO_SITE = $(realpath $(BR2_EXTERNAL_RELIEVO_PATH)/../..)
RELIEVO_SITE_METHOD = local
RELIEVO_OVERRIDE_SRCDIR_RSYNC_EXCLUSIONS = --exclude "/build*" --exclude /out
RELIEVO_LICENSE = Apache-2.0
RELIEVO_LICENSE_FILES = LICENSE
RELIEVO_DEPENDENCIES = \
	host-pkgconf alsa-lib cli11 ffmpeg glm json-for-modern-cpp libass \
	libdrm libegl libevdev libgbm libgles libusb sdl2 tiff tomlplusplus \
	zlib
RELIEVO_CONF_OPTS = \
	-DRELIEVO_DESK=OFF \
	-DRELIEVO_TESTS=OFF \
	-DRELIEVO_EXR=OFF

ifeq ($(BR2_PACKAGE_RELIEVO_GSTREAMER),y)
RELIEVO_DEPENDENCIES += gstreamer1 gst1-plugins-base
RELIEVO_CONF_OPTS += -DRELIEVO_GSTREAMER=ON
else
RELIEVO_CONF_OPTS += -DRELIEVO_GSTREAMER=OFF
endif

ifeq ($(BR2_PACKAGE_RELIEVO_ROSBAG),y)
RELIEVO_DEPENDENCIES += bzip2 lz4 sqlite zstd
RELIEVO_CONF_OPTS += -DRELIEVO_ROSBAG=ON
else
RELIEVO_CONF_OPTS += -DRELIEVO_ROSBAG=OFF
endif

ifeq ($(BR2_PACKAGE_RELIEVO_HEIF),y)
RELIEVO_DEPENDENCIES += libheif
RELIEVO_CONF_OPTS += -DRELIEVO_HEIF=ON
else
RELIEVO_CONF_OPTS += -DRELIEVO_HEIF=OFF
endif

ifeq ($(BR2_PACKAGE_RELIEVO_OPENNI),y)
RELIEVO_CONF_OPTS += -DRELIEVO_OPENNI=ON
else
RELIEVO_CONF_OPTS += -DRELIEVO_OPENNI=OFF
endif

ifeq ($(BR2_PACKAGE_RELIEVO_SCAN),y)
RELIEVO_DEPENDENCIES += lz4
RELIEVO_CONF_OPTS += -DRELIEVO_SCAN=ON
else
RELIEVO_CONF_OPTS += -DRELIEVO_SCAN=OFF
endif

ifeq ($(BR2_PACKAGE_RELIEVO_STEREO_PLAY),y)
RELIEVO_CONF_OPTS += -DRELIEVO_STEREO_PLAY=ON
else
RELIEVO_CONF_OPTS += -DRELIEVO_STEREO_PLAY=OFF
endif

# The user of relievo.service.
define RELIEVO_USERS
	- -1 plugdev -1 - - - - USB devices
	relievo -1 relievo -1 * /var/lib/relievo - video,render,input,audio,plugdev relievo player
endef

$(eval $(cmake-package))

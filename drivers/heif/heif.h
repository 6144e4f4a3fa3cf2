// SPDX-License-Identifier: Apache-2.0
// HEIF photos with depth (portraits of phones) or two views (spatial photos) by libheif.
#pragma once

#include "drivers/floats/picture_file_decoder.h"
#include "drivers/photo/photo.h"

namespace relievo {

// The primary picture and its depth map, an auxiliary picture: both upright. The depth's meaning comes from its
// representation info (ISO/IEC 23008-2, G.14.2) or, without that, from the XMP metadata that phones attach. Without
// depth, the two pictures of a stereo pair (ISO/IEC 23008-12, 6.8.5), with kViewTag.
extern const PhotoKind kHeif;

// The decoders of the streams.
extern const PictureFormat kHeifColor, kHeifDepth, kHeifLeft, kHeifRight;

}  // namespace relievo

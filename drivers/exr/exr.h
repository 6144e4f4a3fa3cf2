// SPDX-License-Identifier: Apache-2.0
// Reads OpenEXR pictures (a renderer's Z buffers and colours) by libOpenEXR.
#pragma once

#include "drivers/floats/picture_file_decoder.h"
#include "drivers/photo/photo.h"

namespace relievo {

// Half, float and whole-number channels, scanlines or tiles, in any compression of the library; the data window inside
// the display window, with holes around it. The depth is a channel Z, depth, distance or disparity of any part and
// layer, by this order, or the first of a layer with depth in its name; else the first part's R, G and B, its Y, or its
// first channel.
extern const PictureFormat kExr;

// R, G and B (or Y) of a file, whatever else it holds.
extern const PictureFormat kExrColor;

// A file with both a depth channel and colours. A depth that by its name is in cm has the tag DEPTH_UNIT.
extern const PhotoKind kExrWithDepth;

}  // namespace relievo

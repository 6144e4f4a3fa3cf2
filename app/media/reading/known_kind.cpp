// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/known_kind.h"

#include <algorithm>

#include "platform/print.h"

namespace relievo {
namespace {

// A Kinect's raw disparity: 11 bits, 2047 for a hole, z = 351.3 / (1092.5 - code) m (Stowers, Hayes and
// Bainbridge-Smith, "Altitude control of a quadrotor helicopter using depth map from Microsoft Kinect sensor", 2011).
constexpr InverseCodes kKinect{351300, 1092.5};
constexpr const char* kKinectCodes = "law=inverse,polarity=near-low,invalid=0+1085-65535";
// KITTI: 256 codes a pixel of disparity; a focal length of 721 pixels and a baseline of 0.54 m.
constexpr InverseCodes kKitti{256 * 721 * 540.0, 0};

constexpr const char* kMillimetres = "unit=1,invalid=0+65535";
constexpr const char* kFiveThousand = "unit=0.2,invalid=0+65535";

constexpr KnownKind kKinds[] = {
    {"mm", "distances in mm", "16 bits: RealSense, Kinect, 7-Scenes, Redwood, NYU, ScanNet, most sensors",
     kMillimetres},
    {"scannet", "distances in mm", "ScanNet's exported pictures", kMillimetres},
    {"tum", "distances, 5000 codes a metre", "TUM RGB-D", kFiveThousand},
    {"icl", "distances, 5000 codes a metre", "ICL-NUIM", kFiveThousand},
    {"ycb", "distances, 10000 codes a metre", "YCB-Video", "unit=0.1,invalid=0+65535"},
    {"matterport", "distances, 4000 codes a metre", "Matterport3D", "unit=0.25,invalid=0+65535"},
    {"taskonomy", "distances, 512 codes a metre", "Taskonomy, 2D-3D-S, Gibson", "unit=1.953125,invalid=0+65535"},
    {"replica", "distances, 6553.5 codes a metre", "Replica as NICE-SLAM renders it", "unit=0.15259,invalid=0"},
    {"vkitti", "distances in cm", "Virtual KITTI; 65535 is the sky", "unit=10,invalid=0+65535"},
    {"unreal", "distances in cm", "Unreal Engine's WorldDepth pass, Maya and others whose floats are cm",
     "unit=10,invalid=0"},
    {"zoedepth", "distances, 256 codes a metre", "ZoeDepth's pictures of 16 bits", "unit=3.90625,invalid=0"},
    {"bop", "distances", "in the unit that a camera's file beside them says (BOP, Open3D, NeRFs), or in mm",
     "invalid=0"},
    {"kitti", "distances, 256 codes a metre", "KITTI depth, from a laser scanner", "unit=3.90625,invalid=0"},
    {.name = "kitti-disparity",
     .what = "disparities, 256 codes a pixel",
     .help = "KITTI stereo",
     .calibration = "law=inverse,polarity=near-high,invalid=0",
     .inverse = kKitti},
    {"middlebury", "disparities in pixels", "Middlebury: PFM or PNG with the cameras of the calib.txt beside it",
     "law=inverse,polarity=near-high,invalid=0"},
    {.name = "sun",
     .what = "distances in mm, rotated left by three bits",
     .help = "SUN RGB-D, SUN3D",
     .calibration = kMillimetres,
     .order = SampleOrder::RotatedLeft3},
    {.name = "mm-swapped",
     .what = "distances in mm, bytes swapped",
     .help = "16-bit pictures that were written in the other byte order",
     .calibration = kMillimetres,
     .order = SampleOrder::Swapped},
    {.name = "rg-packed",
     .what = "distances in mm, in two bytes: red and green",
     .help = "RGB pictures whose red is the upper byte of a code and whose green is the lower one",
     .calibration = kMillimetres,
     .order = SampleOrder::RedGreen},
    {.name = "gr-packed",
     .what = "distances in mm, in two bytes: green and red",
     .help = "the same the other way round",
     .calibration = kMillimetres,
     .order = SampleOrder::GreenRed},
    {.name = "gb-packed",
     .what = "distances in mm, in two bytes: green and blue",
     .help = "the same in green and blue, as NYU Hand Pose has it",
     .calibration = kMillimetres,
     .order = SampleOrder::GreenBlue},
    {.name = "bg-packed",
     .what = "distances in mm, in two bytes: blue and green",
     .help = "the same with red and blue exchanged, as OpenCV writes red and green",
     .calibration = kMillimetres,
     .order = SampleOrder::BlueGreen},
    {.name = "carla",
     .what = "distances of up to 1000 m, 24 bits in red, green and blue",
     .help = "CARLA's depth camera, in its own coding; white is the sky",
     .calibration = "unit=15.2588,invalid=65535",
     .order = SampleOrder::BlueGreen},
    {.name = "carla-near",
     .what = "distances of up to 62 m, 24 bits in red, green and blue",
     .help = "the same indoors, read more finely; what is farther is a hole",
     .calibration = "unit=.953674,invalid=65535",
     .order = SampleOrder::Below20},
    {.name = "tartanair",
     .what = "distances in m, a float in the four bytes of red, green, blue and alpha",
     .help = "TartanAir's PNG; beyond 262 m is the sky",
     .calibration = "unit=4,invalid=0+65535",
     .order = SampleOrder::FloatBytes},
    {.name = "co3d",
     .what = "distances, a half float in the 16 bits of gray",
     .help = "CO3D's and Dynamic Replica's .geometric.png; their unit is read as a metre",
     .calibration = "unit=4,invalid=0+65535",
     .order = SampleOrder::HalfFloat},
    {.name = "interiornet",
     .what = "distances from the camera's centre in mm, read as depth",
     .help = "InteriorNet, whose camera has a focal length of 600 pixels for 640",
     .calibration = kMillimetres,
     .order = SampleOrder::AlongRay},
    {.name = "scenenet",
     .what = "distances from the camera's centre in mm, read as depth",
     .help = "SceneNet RGB-D, whose camera sees 60 x 45 degrees",
     .calibration = kMillimetres,
     .order = SampleOrder::AlongWideRay},
    {.name = "sintel-disparity",
     .what = "disparities in pixels, in red, green and blue",
     .help = "MPI Sintel's PNG: 4 R + G / 64",
     .calibration = "law=inverse,polarity=near-high,invalid=0",
     .order = SampleOrder::RedGreen},
    {.name = "depth16",
     .what = "distances in mm, 13 bits below three of confidence",
     .help = "Android's and ARCore's DEPTH16",
     .calibration = kMillimetres,
     .order = SampleOrder::Low13},
    {.name = "kinect-players",
     .what = "distances in mm; the lowest three bits are the number of a person",
     .help = "Kinect SDK 1, with a number for each person",
     .calibration = kMillimetres,
     .order = SampleOrder::Upper13},
    {.name = "lerobot",
     .what = "distances, in 12 bits of their logarithm",
     .help = "LeRobot's depth films; their range is read from meta/info.json above them, or is 0.01 to 10 m",
     .calibration = "unit=0.2,invalid=0",
     .packing = Packing::DepthAlone,
     .order = SampleOrder(EvenSteps{})},
    {.name = "kinect-raw",
     .what = "raw Kinect disparities",
     .help = "11 bits of a first Kinect, 2047 for a hole",
     .calibration = kKinectCodes,
     .inverse = kKinect},
    {.name = "nyu-raw",
     .what = "raw Kinect disparities, bytes swapped",
     .help = "the raw PGM pictures of NYU Depth",
     .calibration = kKinectCodes,
     .order = SampleOrder::Swapped,
     .inverse = kKinect},
    {.name = "record3d",
     .what = "Record3D's hue over 3 m",
     .help = "RGBD video of an iPhone, depth left, red for holes",
     .calibration = "polarity=near-low",
     .packing = Packing::SideBySideDepthFirst,
     .code = DepthCode::Hue},
    {.name = "realsense",
     .what = "hue, red near",
     .help = "RealSense's colouring by distance; add --calibration near=MM,far=MM",
     .calibration = "law=linear,polarity=near-low",
     .code = DepthCode::Hue},
    {.name = "realsense-disparity",
     .what = "hue of 1/distance, red far",
     .help = "RealSense's colouring by disparity; add --calibration near=MM,far=MM",
     .calibration = "law=inverse,polarity=near-high",
     .code = DepthCode::Hue},
    {.name = "depthkit",
     .what = "Depthkit's hue from near to far",
     .help = "below the colour, black for holes; near and far are read from the .txt or .json beside it",
     .calibration = "polarity=near-low",
     .packing = Packing::TopBottom,
     .code = DepthCode::Hue},
    {.name = "looking-glass",
     .what = "brightness, near bright",
     .help = "right of the colour: RGB-D pictures and films of Looking Glass",
     .calibration = "polarity=near-high",
     .packing = Packing::SideBySide,
     .code = DepthCode::Luma},
    {"heights", "heights", "terrain and relief maps of 16 bits: high codes are near; 0 is a hole",
     "polarity=near-high,invalid=0"},
    {.name = "terrarium",
     .what = "heights, 256 R + G + B / 256 - 32768 m",
     .help = "Terrarium's tiles of terrain (Mapzen, AWS)",
     .calibration = "polarity=near-high,invalid=0",
     .order = SampleOrder::Terrarium},
    {.name = "mapbox",
     .what = "heights, .1 m (65536 R + 256 G + B) - 10000 m",
     .help = "Terrain-RGB tiles (Mapbox, MapTiler)",
     .calibration = "polarity=near-high,invalid=0",
     .order = SampleOrder::Mapbox},
    {.name = "near-bright",
     .what = "brightness, near bright",
     .help = "disparity or inverse depth: MiDaS, Depth Anything, phones, Middlebury",
     .calibration = "polarity=near-high",
     .code = DepthCode::Luma},
    {.name = "near-dark",
     .what = "brightness, near dark",
     .help = "distance as brightness: renderers, ZoeDepth, Marigold",
     .calibration = "polarity=near-low",
     .code = DepthCode::Luma},
};

}  // namespace

double EvenSteps::unitMm() const noexcept {
  constexpr double kUsual = 0.2, kHighest = 0xffff;
  return std::max(kUsual, static_cast<double>(farthest_mm) / kHighest);
}

const KnownKind* findKind(std::string_view name) noexcept {
  const auto kind =
      std::find_if(std::begin(kKinds), std::end(kKinds), [&](const KnownKind& k) { return name == k.name; });
  return kind == std::end(kKinds) ? nullptr : kind;
}

CalibrationSettings settingsOf(const KnownKind& kind) {
  return parseCalibration(kind.calibration).value_or(CalibrationSettings{});
}

std::string kindsText() {
  std::string text;
  for (const KnownKind& kind : kKinds) text += print("%-20s %s: %s\n", kind.name, kind.what, kind.help);
  return text;
}

}  // namespace relievo

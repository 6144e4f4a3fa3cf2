// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/refusal.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/local_file.h"
#include "drivers/ffmpeg/network_error.h"
#include "hal/media/media_names.h"
#include "hal/media/video_decoder.h"
#include "platform/files/answered_file.h"

namespace relievo::ffmpeg {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kHeadBytes = 256;

// Fewer bytes if the file is shorter or cannot be read.
std::string headOf(const std::string& path) {
  std::array<std::uint8_t, kHeadBytes> head{};
  const auto file = AnsweredFile::open(path);
  const std::size_t bytes = file ? file->read(0, head).value_or(0) : 0;
  return {head.begin(), head.begin() + static_cast<std::ptrdiff_t>(bytes)};
}

constexpr const char* kCloud =
    "it is a point cloud; relievo plays depth pictures: give the recording that it was made from";

// Formats that are known by their file name extension, since their files have no fixed beginning or share one.
struct UnreadEnding {
  std::string_view ending;
  const char* line;
};
constexpr const char* kRaw =
    "it is raw numbers without a picture size; convert it: ffmpeg -f rawvideo -pix_fmt gray16le -video_size "
    "WIDTHxHEIGHT "
    "-framerate F -i FILE -c:v ffv1 depth.mkv";
constexpr const char* kText =
    "it is a table of numbers as text; convert it: python3 -c 'import numpy; numpy.save(\"depth.npy\", "
    "numpy.loadtxt(\"FILE\", delimiter=\",\"))'";
constexpr const char* kPython =
    "it is an object of Python; write its depth with numpy.save(\"depth.npy\", ARRAY), which relievo reads";
constexpr const char* kTorch =
    "it is a tensor of PyTorch; convert it: python3 -c 'import numpy, torch; numpy.save(\"depth.npy\", "
    "torch.load(\"FILE\").numpy())'";
constexpr const char* kHdf5 =
    "it is an HDF5 file; convert its first dataset: python3 -c 'import h5py, numpy; numpy.save(\"depth.npy\", "
    "next(iter(h5py.File(\"FILE\").values())))'; for another one: h5py.File(\"FILE\")[\"NAME\"]";
constexpr const char* kMatlab =
    "it is a MATLAB file; convert it: python3 -c 'import scipy.io, numpy; numpy.save(\"depth.npy\", "
    "scipy.io.loadmat(\"FILE\")[\"NAME\"])', NAME being its variable with the depth";
// HDF5 behind a head of its own, whose columns lie behind each other; NYU's depth is called depths.
constexpr const char* kMatlab73 =
    "it is a MATLAB 7.3 file; convert it: python3 -c 'import h5py, numpy; numpy.save(\"depth.npy\", "
    "h5py.File(\"FILE\")[\"NAME\"][:].swapaxes(-1, -2))', NAME being its variable with the depth, such as depths";
constexpr const char* kOpencv =
    "it is a matrix of OpenCV as text; convert it: python3 -c 'import cv2, numpy; numpy.save(\"depth.npy\", "
    "cv2.FileStorage(\"FILE\", 0).getFirstTopLevelNode().mat())'";
constexpr const char* kPacked = "it is compressed; unpack it and name what is in it";
constexpr const char* kModel =
    "it is a 3D model; relievo plays depth pictures: give the recording that it was made from";
constexpr const char* kMedical =
    "it is a medical image, which is not read; if its numbers are depth, write them as 16-bit PNG or .npy";
constexpr const char* kZed = "it is a recording of a ZED camera; convert it: ZED_SVO_Export FILE FOLDER 4";
constexpr std::array<UnreadEnding, 34> kUnreadEndings{{
    {"r3d", "it is a Record3D recording in its own coding; export it in Record3D as RGBD video or as EXR + JPG"},
    {"npz", "it is an archive of arrays; unzip it and name the .npy with the depth"},
    {"zip", "it is an archive; unpack it and name its folder"},
    {"svo", kZed},
    {"svo2", kZed},
    {"raw", kRaw},
    {"bin", kRaw},
    {"yuv",
     "it is raw pictures without a size; convert it: ffmpeg -f rawvideo -pix_fmt FORMAT -video_size "
     "WIDTHxHEIGHT -framerate F -i FILE -c:v ffv1 film.mkv; size and FORMAT are often in its name, as in "
     "depth_320x240_yuv420p16le.yuv; of 8 bits FORMAT is yuv420p, of 10 yuv420p10le, of 16 yuv420p16le"},
    {"sens", "it is a scan, which this relievo was built without; build it with -DRELIEVO_SCAN=ON"},
    {"klg", "it is a scan, which this relievo was built without; build it with -DRELIEVO_SCAN=ON"},
    {"mat", kMatlab},
    {"csv", kText},
    {"pkl", kPython},
    {"pickle", kPython},
    {"pt", kTorch},
    {"pth", kTorch},
    {"yml", kOpencv},
    {"gz", kPacked},
    {"zst", kPacked},
    {"xz", kPacked},
    {"tar", kPacked},
    {"usdz", kModel},
    {"obj", kModel},
    {"glb", kModel},
    {"stl", kModel},
    {"hgt",
     "it is heights of SRTM; convert it: ffmpeg -f rawvideo -pix_fmt gray16be -video_size 1201x1201 -i FILE OUT.png "
     "(3601x3601 if it has 26 MB), and give OUT.png --as heights"},
    {"dmb",
     "it is a depth map of Gipuma or ACMM; convert it: python3 -c 'import numpy; numpy.save(\"depth.npy\", "
     "numpy.fromfile(\"FILE\", \"<f4\")[4:].reshape(numpy.fromfile(\"FILE\", \"<i4\", 3)[1:]))'"},
    {"flo", "it is optical flow, how far each sample moves, and no depth"},
    {"dcm", kMedical},
    {"nii", kMedical},
    {"zdf", "it is a recording of a Zivid camera; convert it with its SDK to a .npy of the distances, or a 16-bit PNG"},
    {"e57", kCloud},
    {"las", kCloud},
    {"blend", "it is a scene of Blender; render its depth (Z) as EXR, which is read"},
}};

struct UnreadFormat {
  std::string_view magic;
  const char* line;
};
constexpr std::array<UnreadFormat, 10> kUnread{{
    {"SQLite format 3\0"sv,
     "it is a database of SQLite, such as a ROS 2 bag, which this relievo was built without; build it with "
     "-DRELIEVO_ROSBAG=ON"},
    {"\x89MCAP0\r\n"sv,
     "it is an MCAP recording, which this relievo was built without; build it with -DRELIEVO_ROSBAG=ON"},
    {"\x89HDF\r\n\x1a\n"sv, kHdf5},
    {"MATLAB 5.0 MAT"sv, kMatlab},
    {"ply\n"sv, kCloud},
    {"ply\r\n"sv, kCloud},
    {"# .PCD"sv, kCloud},
    {"EVENTS1"sv,
     "it is a recording of Kinect Studio; write its depth as 16-bit pictures in mm, such as KinectXEFTools does"},
    // A build that has the readers of these formats passes the files to them.
    {"#ROSBAG V"sv, "it is a ROS bag, which this relievo was built without; build it with -DRELIEVO_ROSBAG=ON"},
    {"NI10"sv, "it is a recording of OpenNI, which this relievo was built without; build it with -DRELIEVO_OPENNI=ON"},
}};

// ISO/IEC 23008-12.
bool isHeic(const std::string& path) {
  const std::string head = headOf(path);
  if (head.size() < 12) return false;
  constexpr std::array<std::string_view, 6> kBrands{"heic", "heix", "heim", "heis", "mif1", "msf1"};
  return head.substr(4, 4) == "ftyp" && std::ranges::find(kBrands, head.substr(8, 4)) != kBrands.end();
}

// FFmpeg refuses a Y4M header of over 268 million samples with a code that says nothing.
bool isTooLargeY4m(const std::string& path) {
  const std::string head = headOf(path);
  if (!head.starts_with("YUV4MPEG2 ")) return false;
  std::istringstream words(head.substr(0, head.find('\n')));
  double samples = 1;
  for (std::string word; words >> word;) {
    if (word[0] == 'W' || word[0] == 'H') samples *= std::strtod(word.c_str() + 1, nullptr);
  }
  return samples > static_cast<double>(VideoDecoder::kMostSamples);
}

// ASCII or UTF-8, whose bytes are never above F4; no container begins with so many bytes without a control character.
bool isText(std::string_view head) {
  const auto is_written = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == '\t' || byte == '\n' || byte == '\r' || (byte >= 0x20 && byte != 0x7F && byte <= 0xF4);
  };
  return !head.empty() && static_cast<unsigned char>(head.front()) < 0xF0 && std::ranges::all_of(head, is_written);
}

// Three numbers, each with a "&" behind it: width, height and channels.
bool isOfColmap(std::string_view head) {
  for (int number = 0; number < 3; ++number) {
    const std::size_t end = head.find_first_not_of("0123456789");
    if (end == 0 || end == head.npos || head[end] != '&') return false;
    head.remove_prefix(end + 1);
  }
  return true;
}

// Files that lack a reader although others of their ending have one; null: none.
const char* unreadVariant(std::string_view head, std::string_view path) {
  constexpr std::size_t kFlags = 20;  // of WebP; 2: it is animated
  const std::string ending = endingOf(path);
  if (head.starts_with("MATLAB 7.3")) return kMatlab73;
  if (path.ends_with(".depth_meters.hdf5"))
    return "it holds Hypersim's distances from the camera's centre, which are no depth yet; name its folder instead: "
           "the command that converts all of it is then printed";
  if (ending == "bin" && isOfColmap(head)) {
    return "it is a depth map of COLMAP; convert it: python3 -c 'import numpy; w, h, c, d = open(\"FILE\", "
           "\"rb\").read().split(b\"&\", 3); numpy.save(\"depth.npy\", numpy.frombuffer(d, \"<f4\").reshape(int(h), "
           "int(w)))'";
  }
  constexpr std::size_t kExrFlags = 5;  // 8: deep; 16: several parts, of which one may be flat
  if (head.starts_with("\x76\x2f\x31\x01") && head.size() > kExrFlags && (head[kExrFlags] & 24) == 8)
    return "it is a deep EXR, of several samples a pixel; flatten it: oiiotool FILE --flatten -o OUT.exr";
  if (ending == "dpt" && !head.starts_with("PIEH")) {
    return "it is no depth of Sintel; if it is LINEMOD's, convert it: python3 -c 'import numpy; "
           "numpy.save(\"depth.npy\", numpy.fromfile(\"FILE\", \"<u2\")[4:].reshape(numpy.fromfile(\"FILE\", "
           "\"<i4\", 2)))'";
  }
  if (ending == "png" && head.find("acTL") != head.npos)
    return "it is an animated PNG; let its name end in .apng, and it is played as a film";
  if (ending == "webp" && head.substr(0, kFlags).ends_with(std::string_view("VP8X\x0a\0\0\0", 8)) &&
      head.size() > kFlags && (head[kFlags] & 2) != 0) {
    return "it is an animated WebP, which FFmpeg cannot read; convert it with ImageMagick: convert FILE %04d.png, and "
           "name the folder";
  }
  return nullptr;
}

}  // namespace

std::optional<Error> unreadFormat(const std::string& path) {
  const std::string head = headOf(path);
  if (const char* const line = head.empty() ? nullptr : unreadVariant(head, path); line != nullptr)
    return Error{ErrorCode::Unsupported, 0, line};
  const auto found =
      std::ranges::find_if(kUnread, [&](const UnreadFormat& format) { return head.starts_with(format.magic); });
  const auto by_ending = std::ranges::find(kUnreadEndings, endingOf(path), &UnreadEnding::ending);
  if (by_ending != kUnreadEndings.end() && !head.empty()) return Error{ErrorCode::Unsupported, 0, by_ending->line};
  if (found == kUnread.end()) return std::nullopt;
  return Error{ErrorCode::Unsupported, 0, found->line};
}

Error lateOpening(Way way) noexcept {
  if (way == Way::File) {
    return {ErrorCode::Timeout, 0, "nothing to play was found in it within 30 s; check whether it is a film"};
  }
  if (way != Way::Pipe) return kLateAnswer;
  return {ErrorCode::Timeout, 0, "no film came through the pipe within 30 s; check the program that writes to it"};
}

Error lateReading(Way way) noexcept {
  if (way == Way::File) {
    return {ErrorCode::Timeout, 0, "nothing more to play was found in it within 10 s; check whether it is whole"};
  }
  if (way != Way::Pipe) return kLateAnswer;
  return {ErrorCode::Timeout, 0, "nothing came through the pipe for 10 s; check the program that writes to it"};
}

Error refusal(const Address& address, int code, const std::string& words) {
  if (code == AVERROR_INVALIDDATA && address.way == Way::File && isHeic(localPathOf(address.url))) {
    return {
        ErrorCode::Unsupported, 0,
        "this FFmpeg cannot read HEIC photos; libheif (RELIEVO_HEIF) reads those with a depth map or two views; save "
        "others as JPEG or PNG"};
  }
  if (address.way == Way::File && isTooLargeY4m(localPathOf(address.url)))
    return {ErrorCode::Unsupported, 0, VideoDecoder::kTooLarge};
  if (code == AVERROR(EMFILE) && address.way == Way::File && headOf(localPathOf(address.url)).starts_with("ffconcat")) {
    return {ErrorCode::Corrupt, 0, "it is a list that names itself, or too many lists; name the films that are in it"};
  }
  if (code == AVERROR_INVALIDDATA && address.way == Way::File && isText(headOf(localPathOf(address.url)))) {
    return {
        ErrorCode::Corrupt, 0,
        "it is text, not a film, despite its name; open it in an editor: a download may have saved a web page; depth "
        "of another program is read from .npy, 16-bit PNG, PFM, EXR or TIFF: write it as one of them"};
  }
  if (!address.remote()) return openError(code);
  // FFmpeg returns EINVAL for what the whitelists of `optionsFor` forbid.
  if (code != AVERROR(EINVAL) || address.way != Way::Http) return networkError(code, words);
  return {ErrorCode::Unsupported, 0,
          "it is no film, or a playlist that names files or protocols forbidden to network sources; check the "
          "address"};
}

}  // namespace relievo::ffmpeg

// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/other_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "drivers/pictures/roles.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_file.h"
#include "platform/files/answered_place.h"

namespace relievo::pictures {
namespace {

constexpr const char* kRaw =
    "this folder holds raw numbers without a picture size; convert each file: ffmpeg -f rawvideo -pix_fmt gray16le "
    "-video_size WIDTHxHEIGHT -i FILE FILE.png";
constexpr const char* kRawFilms =
    "this folder holds raw pictures without a size; convert each file: ffmpeg -f rawvideo -pix_fmt FORMAT -video_size "
    "WIDTHxHEIGHT -framerate F -i FILE -c:v ffv1 FILE.mkv; size and FORMAT are often in its name, as in "
    "depth_320x240_yuv420p16le.yuv; of 8 bits FORMAT is yuv420p, of 10 yuv420p10le, of 16 yuv420p16le";
constexpr const char* kHdf5 =
    "this folder holds HDF5 files; convert the first dataset of each: python3 -c 'import glob, h5py, numpy; "
    "[numpy.save(f, next(iter(h5py.File(f).values()))) for f in glob.glob(\"FOLDER/*5\")]'";
constexpr const char* kMatlab =
    "this folder holds MATLAB files; convert them: python3 -c 'import glob, numpy, scipy.io; [numpy.save(f[:-4], "
    "scipy.io.loadmat(f)[\"NAME\"]) for f in glob.glob(\"FOLDER/*.mat\")]', NAME being the variable with the depth";
// The command converts distances from the camera's centre to depth along its axis, for the camera that the data set's
// README describes: 1024 x 768 pixels, a focal length of 886.81 pixels.
constexpr const char* kHypersim =
    "this folder holds Hypersim's distances from the camera's centre; convert them to depth: python3 -c 'import glob, "
    "h5py, numpy; y, x = numpy.mgrid[-383.5:384, -511.5:512] / 886.81; [numpy.save(f[:-5], "
    "h5py.File(f)[\"dataset\"][:] "
    "/ numpy.sqrt(1 + x * x + y * y)) for f in glob.glob(\"FOLDER/*.depth_meters.hdf5\")]'";
constexpr const char* kRecord3d =
    "this folder holds Record3D's depth in Apple's LZFSE, which is not read; let the app export the film as MP4, or as "
    "EXR and RGB";
// HDF5 behind a head of its own, whose columns lie behind each other.
constexpr const char* kMatlab73 =
    "this folder holds MATLAB 7.3 files; convert them: python3 -c 'import glob, h5py, numpy; [numpy.save(f[:-4], "
    "h5py.File(f)[\"NAME\"][:].swapaxes(-1, -2)) for f in glob.glob(\"FOLDER/*.mat\")]', NAME being the variable with "
    "the depth";

bool isMatlab73(const std::string& path) {
  constexpr std::string_view kBegins = "MATLAB 7.3";
  std::array<std::uint8_t, kBegins.size()> head{};
  const auto file = AnsweredFile::open(path);
  return file && file->read(0, head).value_or(0) == head.size() &&
         std::equal(head.begin(), head.end(), kBegins.begin());
}

struct Way {
  const char *ending, *line;
};
constexpr Way kWays[] = {{"raw", kRaw}, {"bin", kRaw},    {"yuv", kRawFilms},  {"hdf5", kHdf5},
                         {"h5", kHdf5}, {"mat", kMatlab}, {"depth", kRecord3d}};

}  // namespace

Result<Listing> listingOf(const std::string& folder, std::size_t& may_list) {
  if (may_list == 0) return fail(ErrorCode::NotFound, kNoPictures);
  --may_list;
  const auto entries = listFolder(folder.empty() ? "." : folder);
  if (!entries) return std::unexpected(entries.error());
  const std::string place = folder.empty() || folder.ends_with('/') ? folder : folder + "/";
  Listing listing;
  bool depth_way = false;
  for (const auto& [name, is] : *entries) {
    if (name.starts_with('.')) continue;
    if (!depth_way && (listing.way == nullptr || roleOf(name) == Role::Depth)) {  // the former opens files of MATLAB
      if (const char* const way = wayToConvert(place, name); way != nullptr) {
        listing.way = way;
        depth_way = roleOf(name) == Role::Depth;
      }
    }
    const MediaKind kind = mediaKindOf(name);
    if (kind == MediaKind::Picture) listing.pictures.push_back(name);
    else if (kind == MediaKind::Film) ++listing.films;
    else if (is == FolderEntry::Kind::Folder) listing.folders.push_back(name);
  }
  return listing;
}

const char* wayToConvert(const std::string& folder, std::string_view name) {
  if (name.ends_with(".depth_meters.hdf5")) return kHypersim;
  const std::string ending = endingOf(name);
  if (ending == "mat" && isMatlab73(folder + std::string(name))) return kMatlab73;
  for (const Way& way : kWays) {
    if (ending == way.ending) return way.line;
  }
  return nullptr;
}

}  // namespace relievo::pictures

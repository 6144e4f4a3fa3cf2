// SPDX-License-Identifier: Apache-2.0
// Finds the channels of depth or colour and reads them as floats.
#include "drivers/exr/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "drivers/exr/exr_header.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

constexpr int kLongestSide = 32768;
constexpr int kLongestTile = 4096;  // a decoder holds whole tiles
constexpr float kHalfMax = 65504;   // a half that holds it was clipped there
constexpr std::array<std::uint8_t, 4> kMagic{0x76, 0x2f, 0x31, 0x01};

// The library reads from it; its errors are exceptions.
class Bytes final : public Imf::IStream {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : Imf::IStream("picture"), bytes_(bytes) {}
  bool read(char to[], int count) override {
    if (count < 0 || bytes_.size() - at_ < static_cast<std::size_t>(count)) throw std::runtime_error("it ends early");
    std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("it ends early");
    at_ = static_cast<std::size_t>(position);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

// "View Layer.Depth.Z": layers before the last dot.
std::string lastPart(const std::string& name) {
  return lowerCase(name.substr(name.rfind('.') + 1));
}

bool isReadable(const Imf::Channel& channel) noexcept {
  return channel.xSampling == 1 && channel.ySampling == 1;
}

bool says(const char* word, const std::string& name) {
  return lowerCase(name).find(word) != name.npos;
}

constexpr const char* kCentimetres = "worlddepth";  // Unreal Engine's

// The first channel of one of the `words`, without a layer if there is one; empty: none.
std::string channelNamed(const Imf::ChannelList& channels, std::initializer_list<const char*> words) {
  std::string found;
  for (const char* const word : words) {
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
      const std::string name = channel.name();
      if (!isReadable(channel.channel()) || lastPart(name) != word) continue;
      if (found.empty() || name.size() < found.size()) found = name;
    }
    if (!found.empty()) return found;
  }
  return found;
}

using Names = std::vector<std::string>;  // one, or three: red, green, blue

Names colorChannels(const Imf::ChannelList& all) {
  constexpr std::array<const char*, 4> kOthers{"depth", "mask", "motion", "normal"};
  Imf::ChannelList channels;
  for (auto channel = all.begin(); channel != all.end(); ++channel) {
    const bool other =
        std::any_of(kOthers.begin(), kOthers.end(), [&](const char* word) { return says(word, channel.name()); });
    if (!other) channels.insert(channel.name(), channel.channel());
  }
  Names names{channelNamed(channels, {"r", "red"}), channelNamed(channels, {"g", "green"}),
              channelNamed(channels, {"b", "blue"})};
  if (!names[0].empty() && !names[1].empty() && !names[2].empty()) return names;
  const std::string gray = channelNamed(channels, {"y", "r"});
  return gray.empty() ? Names{} : Names{gray};
}

// The channel of a layer whose own name says depth: "FinalImageMovieRenderQueue_WorldDepth.R", "VRayZDepth".
std::string channelOfDepth(const Imf::ChannelList& channels) {
  for (const char* const word : {kCentimetres, "depth"}) {
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
      const std::string name = channel.name(), last = lastPart(name);
      const bool first = last == "r" || last == "red" || last == "v" || last.ends_with("depth");
      if (first && isReadable(channel.channel()) && says(word, name)) return name;
    }
  }
  return "";
}

// The component of a vector, such as a normal or a position, beside its X.
bool isOfVector(const Imf::ChannelList& all, const std::string& name) {
  const std::string last = lastPart(name), layer = name.substr(0, name.size() - last.size());
  return last == "z" && (all.findChannel(layer + "X") != nullptr || all.findChannel(layer + "x") != nullptr);
}

Names namedDepth(const Imf::ChannelList& all) {
  Imf::ChannelList channels, mist;  // Blender's mist goes from 0 to 1: it is depth where there is no other
  for (auto channel = all.begin(); channel != all.end(); ++channel) {
    if (isOfVector(all, channel.name())) continue;
    (says("mist", channel.name()) ? mist : channels).insert(channel.name(), channel.channel());
  }
  std::string depth = channelNamed(channels, {"z", "depth", "distance", "zdepth", "pz", "disparity", "disp"});
  if (depth.empty()) depth = channelOfDepth(channels);
  if (depth.empty()) depth = channelNamed(mist, {"z"});
  return depth.empty() ? Names{} : Names{depth};
}

Names anyDepth(const Imf::ChannelList& channels) {
  if (Names colors = colorChannels(channels); !colors.empty()) return colors;
  const auto first = channels.begin();
  if (first == channels.end() || !isReadable(first.channel())) return {};
  return {first.name()};
}

std::optional<FilePicture> readChannels(Imf::InputPart& part, const Names& names) {
  const Imath::Box2i& data = part.header().dataWindow();
  const Imath::Box2i& display = part.header().displayWindow();
  const auto sizeOf = [](int low, int high) { return std::int64_t{high} - low + 1; };
  const std::int64_t cols = sizeOf(display.min.x, display.max.x), rows = sizeOf(display.min.y, display.max.y);
  const std::int64_t across = sizeOf(data.min.x, data.max.x), down = sizeOf(data.min.y, data.max.y);
  if (std::min({cols, rows, across, down}) < 1) return std::nullopt;
  if (!isSoundSize(static_cast<std::uint64_t>(cols), static_cast<std::uint64_t>(rows)) ||
      !isSoundSize(static_cast<std::uint64_t>(across), static_cast<std::uint64_t>(down)))
    return std::nullopt;

  FilePicture picture{.width = static_cast<int>(cols), .height = static_cast<int>(rows)};
  picture.components = static_cast<int>(names.size());
  picture.samples.assign(static_cast<std::size_t>(cols * rows) * names.size(),
                         names.size() == 1 ? std::numeric_limits<float>::quiet_NaN() : 0.0F);
  std::vector<float> window(static_cast<std::size_t>(across * down));
  for (std::size_t k = 0; k < names.size(); ++k) {
    Imf::FrameBuffer buffer;
    buffer.insert(names[k], Imf::Slice::Make(Imf::FLOAT, window.data(), data, sizeof(float),
                                             static_cast<std::size_t>(across) * sizeof(float)));
    part.setFrameBuffer(buffer);
    part.readPixels(data.min.y, data.max.y);
    const bool half = part.header().channels()[names[k].c_str()].type == Imf::HALF;
    for (int y = std::max(data.min.y, display.min.y); y <= std::min(data.max.y, display.max.y); ++y) {
      for (int x = std::max(data.min.x, display.min.x); x <= std::min(data.max.x, display.max.x); ++x) {
        const float value = window[static_cast<std::size_t>((y - data.min.y) * across + (x - data.min.x))];
        const auto at = static_cast<std::size_t>((y - display.min.y) * cols + (x - display.min.x));
        const bool clipped = half && value >= kHalfMax;
        picture.samples[at * names.size() + k] = clipped ? std::numeric_limits<float>::infinity() : value;
      }
    }
  }
  return picture;
}

// Deep pictures hold several samples a pixel.
bool isFlat(const Imf::Header& header) {
  return !header.hasType() || header.type() == Imf::SCANLINEIMAGE || header.type() == Imf::TILEDIMAGE;
}

// A part's number and the channels to read; none: no names.
struct Choice {
  int part = 0;
  Names names;
};
// The first part in which `choose` finds channels.
template <class Choose>
Choice choosePart(const Imf::MultiPartInputFile& file, Choose&& choose) {
  for (int i = 0; i < file.parts(); ++i) {
    if (!isFlat(file.header(i))) continue;
    if (Names names = choose(file.header(i).channels()); !names.empty()) return {i, std::move(names)};
  }
  return {};
}

template <class Choose>
std::optional<FilePicture> readFile(std::span<const std::uint8_t> file, Choose&& choose) {
  if (!exr::fitsItsHeaders(file)) return std::nullopt;
  try {
    Bytes bytes(file);
    Imf::Header::setMaxImageSize(kLongestSide, kLongestSide);
    Imf::Header::setMaxTileSize(kLongestTile, kLongestTile);
    Imf::MultiPartInputFile parts(bytes, 0);
    const Choice choice = choose(parts);
    if (choice.names.empty()) return std::nullopt;
    Imf::InputPart part(parts, choice.part);
    return readChannels(part, choice.names);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::string viewOf(const Imf::Header& header) {
  return header.hasView() ? header.view() : "";
}

// The colour layer, of the same view as the depth if there are several views.
Choice chooseColor(const Imf::MultiPartInputFile& file) {
  const Choice depth = choosePart(file, namedDepth);
  for (int i = 0; i < file.parts() && !depth.names.empty(); ++i) {
    if (!isFlat(file.header(i)) || viewOf(file.header(i)) != viewOf(file.header(depth.part))) continue;
    if (Names names = colorChannels(file.header(i).channels()); !names.empty()) return {i, std::move(names)};
  }
  return choosePart(file, colorChannels);
}
// Channels in any part whose names say depth; else the other channels.
Choice chooseDepth(const Imf::MultiPartInputFile& file) {
  const Choice named = choosePart(file, namedDepth);
  return named.names.empty() ? choosePart(file, anyDepth) : named;
}

std::optional<FilePicture> readDepth(std::span<const std::uint8_t> file) {
  return readFile(file, chooseDepth);
}
std::optional<FilePicture> readColor(std::span<const std::uint8_t> file) {
  return readFile(file, chooseColor);
}

}  // namespace

const PictureFormat kExr{"exr", readDepth};
const PictureFormat kExrColor{"exr-color", readColor};

namespace {

bool beginsLikeExr(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

// Nuke's own depth is 1/z, 0 for nothing (the manual of its node DepthToPosition); what another renderer has made and
// Nuke passes on is z, which few scenes have below 1.
bool isNukesInverse(const Imf::Header& header, std::span<const std::uint8_t> file) {
  if (header.find("nuke/version") == header.end()) return false;
  const auto depth = readDepth(file);
  return depth && std::all_of(depth->samples.begin(), depth->samples.end(),
                              [](float value) { return !(value < 0 || value > 1); });
}

std::vector<PhotoPart> partsOf(const PhotoBytes& file) {
  if (!exr::fitsItsHeaders(*file)) return {};
  StreamInfo depth{.codec = kExr.codec, .tags = {{"TITLE", "depth"}}};
  try {
    Bytes bytes(*file);
    const Imf::MultiPartInputFile parts(bytes, 0);
    const Choice named = choosePart(parts, namedDepth);
    if (named.names.empty() || chooseColor(parts).names.size() != 3) return {};
    if (says(kCentimetres, named.names[0])) depth.tags["DEPTH_UNIT"] = "10";
    else if (isNukesInverse(parts.header(named.part), *file)) depth.tags["DEPTH_LAW"] = "inverse";
  } catch (const std::exception&) {
    return {};
  }
  return {PhotoPart{.stream = {.codec = kExrColor.codec}, .coded = *file, .owner = file},
          PhotoPart{.stream = depth, .coded = *file, .owner = file}};
}

}  // namespace

const PhotoKind kExrWithDepth{beginsLikeExr, partsOf};

}  // namespace relievo

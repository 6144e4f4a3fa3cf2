// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/roles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>

#include "hal/media/media_names.h"
#include "platform/lower_case.h"

namespace relievo::pictures {
namespace {

constexpr std::array<std::string_view, 9> kDepth{"xyz",  "depth",    "depths",    "disparity", "disparities",
                                                 "disp", "depthmap", "depthcrop", "mist"};
constexpr std::array<std::string_view, 14> kColor{"rgb", "color", "colour", "image", "images", "img",   "colors",
                                                  "im",  "wide",  "rgba",   "clean", "pv",     "photo", "cam"};
constexpr std::array<std::string_view, 28> kOther{
    "flow",     "flows", "segmentation", "coordinates", "occlusion", "occlusions", "outofframe",
    "semantic", "ab",    "mask",         "masks",       "maskcrop",  "normal",     "normals",
    "seg",      "label", "labels",       "instance",    "infrared",  "ir",         "pose",
    "thumb",    "cover", "preview",      "confidence",  "conf",      "intrinsics", "masked"};

std::vector<std::string> wordsOf(std::string_view name) {
  std::vector<std::string> words(1);
  for (const unsigned char c : name) {
    if (std::isalpha(c) != 0) words.back() += static_cast<char>(std::tolower(c));
    else if (!words.back().empty()) words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

template <std::size_t N>
bool holdsOne(const std::vector<std::string>& words, const std::array<std::string_view, N>& known) {
  return std::ranges::any_of(words, [&](const auto& word) { return std::ranges::find(known, word) != known.end(); });
}

// Depth in the colour's view, where both are there (RealSense, OpenLORIS, ROS, Azure Kinect).
constexpr std::array<std::string_view, 3> kInColorsView{"aligned", "registered", "transformed"};

// Depth painted for the eye, beside the codes themselves.
constexpr std::array<std::string_view, 10> kPainted{"vis",      "viz",       "visual", "visualization", "colored",
                                                    "coloured", "colorized", "color",  "colormap",      "heatmap"};

// NYU's raw files: "d-1294886362.665769-3143787185.pgm".
bool beginsWith(std::string_view name, char letter) {
  return name.size() > 2 && name[0] == letter && name[1] == '-' &&
         std::isdigit(static_cast<unsigned char>(name[2])) != 0;
}

}  // namespace

Role roleOf(std::string_view name) {
  const std::vector<std::string> words = wordsOf(name);
  if (holdsOne(words, kOther)) return Role::Other;
  const char letter = matterportLetter(name);
  if (holdsOne(words, kDepth) || beginsWith(name, 'd') || letter == 'd') return Role::Depth;
  return holdsOne(words, kColor) || beginsWith(name, 'r') || letter == 'i' ? Role::Color : Role::Unsaid;
}

std::string keyOf(std::string_view name) {
  const std::string_view stem = name.substr(0, name.rfind('.'));
  const auto kindOf = [](unsigned char c) {  // beyond ASCII all are letters
    return std::isalpha(c) != 0 || c >= 0x80 ? 2 : std::isdigit(c) != 0 ? 1 : 0;
  };
  std::string key;
  for (std::size_t from = 0, end = 0; from < stem.size(); from = end) {
    const int kind = kindOf(static_cast<unsigned char>(stem[from]));
    while (end < stem.size() && kindOf(static_cast<unsigned char>(stem[end])) == kind) ++end;
    const std::string part = lowerCase(stem.substr(from, end - from));
    if (kind != 0 && !holdsOne({part}, kDepth) && !holdsOne({part}, kColor)) key += part + ' ';
  }
  return key;
}

bool isPaintedDepth(std::string_view name) {
  return roleOf(name) == Role::Depth && holdsOne(wordsOf(name), kPainted);
}

void keepLeftView(std::vector<std::string>& names) {
  const auto says = [](std::string_view view) {
    return [view](const std::string& name) { return holdsOne(wordsOf(name), std::array{view}); };
  };
  if (std::ranges::any_of(names, says("left"))) std::erase_if(names, says("right"));
}

std::string bestOf(const std::vector<std::string>& names, Role role) {
  std::vector<std::string> found;
  std::ranges::copy_if(names, std::back_inserter(found), [role](const auto& name) { return roleOf(name) == role; });
  if (found.empty()) return "";
  return *std::ranges::min_element(found, [](const std::string& a, const std::string& b) {
    const auto words_a = wordsOf(a), words_b = wordsOf(b);
    if (isPaintedDepth(a) != isPaintedDepth(b)) return isPaintedDepth(b);
    const bool aligned_a = holdsOne(words_a, kInColorsView), aligned_b = holdsOne(words_b, kInColorsView);
    if (aligned_a != aligned_b) return aligned_a;
    return words_a.size() != words_b.size() ? words_a.size() < words_b.size() : naturalLess(a, b);
  });
}

}  // namespace relievo::pictures

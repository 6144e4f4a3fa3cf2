// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/roles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include "hal/media/media_names.h"
#include "platform/text/lower_case.h"

namespace relievo::pictures {
namespace {

// Beside kDepthWords.
constexpr std::array<std::string_view, 7> kDepth{"xyz",       "dpt",      "distance", "depthcrop",
                                                 "depthmaps", "rawdepth", "mist"};
constexpr std::array<std::string_view, 14> kColor{"rgb", "color", "colour", "image", "images", "img",   "colors",
                                                  "im",  "wide",  "rgba",   "clean", "pv",     "photo", "cam"};
constexpr std::array<std::string_view, 41> kOther{
    "thermal",    "flow",       "flows",       "segmentation", "coordinates", "occlusion", "occlusions",
    "outofframe", "semantic",   "ab",          "mask",         "masks",       "maskcrop",  "normal",
    "normals",    "seg",        "label",       "labels",       "instance",    "infrared",  "ir",
    "pose",       "thumb",      "cover",       "preview",      "confidence",  "conf",      "intrinsics",
    "masked",     "annotation", "annotations", "semantics",    "instances",   "nir",       "infra",
    "lwir",       "amplitude",  "intensity",   "features",     "feature",     "albedo"};

std::vector<std::string> sortedWordsOf(std::string_view name) {
  auto words = wordsOf(name);
  std::ranges::sort(words);
  return words;
}

template <std::size_t N>
bool holdsOne(const std::vector<std::string>& words, const std::array<std::string_view, N>& known) {
  return std::ranges::any_of(words, [&](const auto& word) { return std::ranges::find(known, word) != known.end(); });
}

bool holdsDepth(const std::vector<std::string>& words) {
  return holdsOne(words, kDepthWords) || holdsOne(words, kDepth);
}

// Depth in the colour's view, where both are there (RealSense, OpenLORIS, ROS, Azure Kinect).
constexpr std::array<std::string_view, 3> kInColorsView{"aligned", "registered", "transformed"};

// Depth painted for the eye, beside the codes themselves.
constexpr std::array<std::string_view, 10> kPainted{"vis",      "viz",       "visual", "visualization", "colored",
                                                    "coloured", "colorized", "color",  "colormap",      "heatmap"};

Role roleOfWords(const std::vector<std::string>& words) {
  if (holdsOne(words, kOther)) return Role::Other;
  if (holdsDepth(words)) return Role::Depth;
  return holdsOne(words, kColor) ? Role::Color : Role::Unsaid;
}

// "Kinect Depth" of "KinectDepth": a capital behind a small letter begins a word.
std::string partedAtCapitals(std::string_view name) {
  std::string parted;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto is = [&](int (*kind)(int), std::size_t at) { return kind(static_cast<unsigned char>(name[at])) != 0; };
    if (i > 0 && is(std::isupper, i) && is(std::islower, i - 1)) parted += ' ';
    parted += name[i];
  }
  return parted;
}

// The words that a name joins: "depth" of "depthImages" and of "depthimages".
std::vector<std::string> partsOf(std::string_view name) {
  constexpr std::array<std::string_view, 6> kPictures{"images", "image", "imgs", "img", "frames", "frame"};
  std::vector<std::string> parts = wordsOf(partedAtCapitals(name));
  for (std::string& part : parts) {
    const auto ends = [&](std::string_view end) { return part.size() > end.size() && part.ends_with(end); };
    const auto end = std::ranges::find_if(kPictures, ends);
    if (end != kPictures.end()) part.resize(part.size() - end->size());
  }
  return parts;
}

// NYU's raw files: "d-1294886362.665769-3143787185.pgm".
bool beginsWith(std::string_view name, char letter) {
  return name.size() > 2 && name[0] == letter && name[1] == '-' &&
         std::isdigit(static_cast<unsigned char>(name[2])) != 0;
}

// The runs of digits, parted by spaces.
std::string digitsOf(std::string_view name) {
  std::string digits;
  bool parted = false;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9';
    if (digit && parted && !digits.empty()) digits += ' ';
    if (digit) digits += c;
    parted = !digit;
  }
  return digits;
}

// The names by what is said behind their first `common` letters.
std::map<Role, std::vector<std::string>> byRoleBehind(std::size_t common, const std::vector<std::string>& names) {
  std::map<Role, std::vector<std::string>> by_role;
  Roles roles;
  for (const std::string& name : names) by_role[roles.of(name.substr(common))].push_back(name);
  return by_role;
}

// Where the words end that all names begin with.
std::size_t endOfCommonWords(const std::vector<std::string>& names) {
  std::string_view common = names.front();
  for (const std::string& name : names) {
    const auto same = std::ranges::mismatch(common, name).in1;
    common = common.substr(0, static_cast<std::size_t>(same - common.begin()));
  }
  return common.find_last_of("_-. ") + 1;  // 0 for none
}

// Whether a picture or a folder of this name is to be preferred to the other.
bool isBetter(const std::string& a, const std::string& b) {
  const auto words_a = wordsOf(a), words_b = wordsOf(b);
  const auto isPaintedDepth = [](const std::string& name, const std::vector<std::string>& words) {
    return roleOf(name) == Role::Depth && holdsOne(words, kPainted);
  };
  const bool painted_a = isPaintedDepth(a, words_a), painted_b = isPaintedDepth(b, words_b);
  if (painted_a != painted_b) return painted_b;
  const bool aligned_a = holdsOne(words_a, kInColorsView), aligned_b = holdsOne(words_b, kInColorsView);
  if (aligned_a != aligned_b) return aligned_a;
  return words_a.size() != words_b.size() ? words_a.size() < words_b.size() : naturalLess(a, b);
}

}  // namespace

Role roleOf(std::string_view name) {
  if (name == "D") return Role::Depth;  // a folder; others of one letter are takes, or slices
  const Role role = roleOfWords(wordsOf(name));
  const char letter = matterportLetter(name);
  if (role == Role::Other || role == Role::Depth) return role;
  if (beginsWith(name, 'd') || letter == 'd') return Role::Depth;
  const Role joined = roleOfWords(partsOf(name));
  if (joined == Role::Depth) return Role::Depth;
  return role == Role::Color || beginsWith(name, 'r') || letter == 'i' ? Role::Color : joined;
}

Role Roles::of(const std::string& name) {
  std::string same = name;
  std::ranges::replace_if(same, [](unsigned char c) { return std::isdigit(c) != 0; }, '0');
  const bool digits_tell = matterportLetter(name) != '\0';
  if (digits_tell || same != before_) role_ = roleOf(name);
  before_ = digits_tell ? "" : std::move(same);
  return role_;
}

std::map<Role, std::vector<std::string>> byRole(const std::vector<std::string>& names) {
  auto by_role = byRoleBehind(0, names);
  if (names.empty() || by_role[Role::Depth].size() < names.size()) return by_role;
  auto apart = byRoleBehind(endOfCommonWords(names), names);
  return apart[Role::Color].empty() || apart[Role::Depth].empty() ? by_role : apart;
}

std::string keyOf(std::string_view name) {
  const auto saysRole = [](std::string_view word) {
    const Role role = roleOfWords(partsOf(word));
    return role == Role::Depth || role == Role::Color;
  };
  const std::string_view stem = stemOf(name);
  const auto kindOf = [](unsigned char c) {  // beyond ASCII all are letters
    return std::isalpha(c) != 0 || c >= 0x80 ? 2 : std::isdigit(c) != 0 ? 1 : 0;
  };
  std::string key;
  for (std::size_t from = 0, end = 0; from < stem.size(); from = end) {
    const int kind = kindOf(static_cast<unsigned char>(stem[from]));
    while (end < stem.size() && kindOf(static_cast<unsigned char>(stem[end])) == kind) ++end;
    const std::string_view part = stem.substr(from, end - from);
    if (kind == 0) continue;
    const bool joined = kind == 2 && saysRole(part);
    for (const std::string& word : joined ? wordsOf(partedAtCapitals(part)) : std::vector{lowerCase(part)}) {
      if (!saysRole(word)) key += word + ' ';
    }
  }
  return key;
}

std::size_t likeness(const std::vector<std::string>& names, const std::vector<std::string>& others) {
  std::set<std::string> keys;
  for (const std::string& name : others) keys.insert(keyOf(name));
  const auto shared = std::ranges::count_if(names, [&](const auto& name) { return keys.contains(keyOf(name)); });
  return std::max<std::size_t>(static_cast<std::size_t>(shared), names.size() == others.size() ? 1 : 0);
}

bool isPainted(std::string_view name) {
  return holdsOne(wordsOf(name), kPainted);
}

std::size_t keepBestDepth(std::vector<std::string>& names) {
  if (names.empty()) return 0;
  using Words = std::vector<std::string>;
  struct Kind {
    std::set<std::string> digits;
    std::string first;  // of the names
  };
  std::map<Words, Kind> kinds;
  std::vector<const Words*> words_of;
  for (const std::string& name : names) {
    auto& [words, kind] = *kinds.try_emplace(sortedWordsOf(stemOf(name))).first;
    words_of.push_back(&words);
    kind.digits.insert(digitsOf(stemOf(name)));
    if (kind.first.empty() || naturalLess(name, kind.first)) kind.first = name;
  }
  const auto isBetterKind = [](const auto& a, const auto& b) { return isBetter(a.second.first, b.second.first); };
  const auto best = std::ranges::min_element(kinds, isBetterKind);
  const bool named = !keyOf(best->second.first).empty();  // "beach", not "depth"
  const bool painted = holdsOne(best->first, kPainted);
  std::set<const Words*> left_out;
  for (const auto& [words, kind] : kinds) {
    const bool related = std::ranges::includes(words, best->first) || std::ranges::includes(best->first, words);
    const bool same = related && std::ranges::any_of(kind.digits, [&](const auto& each) {
                        return (!each.empty() || !named) && best->second.digits.contains(each);
                      });
    if (&words != &best->first && (same || (!painted && holdsOne(words, kPainted)))) left_out.insert(&words);
  }
  std::size_t place = 0;
  return std::erase_if(names, [&](const auto&) { return left_out.contains(words_of[place++]); });
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
  return *std::ranges::min_element(found, isBetter);
}

}  // namespace relievo::pictures

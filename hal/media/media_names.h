// SPDX-License-Identifier: Apache-2.0
// What a file's name says: a film, a picture or neither; depth; and the order of numbered names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relievo {

// The tag of a stream of pictures that names its first file: of depth, or of the only series.
inline constexpr const char* kFileTag = "FILE";

// The tag of the depth of a recording whose layout is known, which does not say for sure what its codes are: "tum".
inline constexpr const char* kLayoutTag = "LAYOUT";

// The tag of a stream of two views that says whether each was squeezed by half: 1 or 0.
inline constexpr const char* kSqueezedTag = "STEREO_SQUEEZED";
// The tag of a stream that is one of two views: left or right.
inline constexpr const char* kViewTag = "STEREO_VIEW";
// The tag of a stream that announces two views, each in a layer of its own (MV-HEVC): how many of them its pictures
// hold, 2 or 1.
inline constexpr const char* kLayersTag = "STEREO_LAYERS";

enum class MediaKind : std::uint8_t { Film, Picture, Neither };

// By the ending alone, in upper or lower case.
[[nodiscard]] MediaKind mediaKindOf(std::string_view name) noexcept;

// "png" of "a/B.PNG": in lower case; empty if the name has no ending.
[[nodiscard]] std::string endingOf(std::string_view name);

// "B" of "B.PNG", the name of a file without its folder.
[[nodiscard]] constexpr std::string_view stemOf(std::string_view name) noexcept {
  return name.substr(0, name.rfind('.'));
}

// The words that say that what a name stands for is depth, the usual one first.
inline constexpr std::array<std::string_view, 7> kDepthWords{"depth",       "disparity", "disp",        "depths",
                                                             "disparities", "depthmap",  "disparitymap"};
// The words of a name, in small letters: anything but letters parts them.
[[nodiscard]] std::vector<std::string> wordsOf(std::string_view name);
// A camera's picture by its ending: JPEG and its stereo kinds, HEIF.
[[nodiscard]] bool isPhotoName(std::string_view name);
// Whether a word of a file's name is one of kDepthWords; neither the ending nor the names of folders count, nor
// "depths" in a title of words parted by blanks or points ("The Lower Depths").
[[nodiscard]] bool saysDepth(std::string_view path);

// Whether a folder with so many films and pictures is a list of films; else it is a series of pictures.
[[nodiscard]] constexpr bool isListOfFilms(std::size_t films, std::size_t pictures) noexcept {
  constexpr std::size_t kCovers = 10;  // pictures beside each film
  return films > 0 && pictures <= kCovers * films;
}

// True if `a` comes before `b` when runs of digits count as numbers: "2.png" before "10.png".
[[nodiscard]] bool naturalLess(std::string_view a, std::string_view b) noexcept;

// The letter in a name of Matterport3D's form, such as "0f37bd0737e349de9d536263a4bdd60d_d0_3.png": 'd' for depth, 'i'
// for colour; '\0' for any other name.
[[nodiscard]] char matterportLetter(std::string_view name) noexcept;

}  // namespace relievo

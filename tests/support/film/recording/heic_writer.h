// SPDX-License-Identifier: Apache-2.0
// HEIC files, box by box (ISO/IEC 14496-12, 23008-12), for tests.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace relievo::test {

inline constexpr int kHeicCols = 96, kHeicRows = 64;

// A picture that FFmpeg has coded.
struct HevcPicture {
  std::string parameters;  // hvcC
  std::string picture;
  int cols = kHeicCols, rows = kHeicRows;
};
// sample(component, column, row, 0), as for ClipTrack. Throws where FFmpeg lacks the coder.
[[nodiscard]] HevcPicture hevcPicture(const std::function<std::uint32_t(int, int, int, int)>& sample,
                                      int cols = kHeicCols, int rows = kHeicRows);

struct HeicLayout {
  int quarter_turns = 0;  // anticlockwise, as irot says
  std::string xmp;        // of the second picture
  bool auxiliary = true;  // the second picture is the first one's disparity
  std::string groups;     // behind the properties: grpl
};
// Item 1 is the primary picture, item 2 the other, item 3 the XMP.
[[nodiscard]] std::string heicFile(const HevcPicture& first, const HevcPicture& second, const HeicLayout& how);

// A box, and a group of entities.
[[nodiscard]] std::string heicBox(const std::string& type, const std::string& content);
[[nodiscard]] std::string heicGroup(const std::string& type, const std::vector<std::uint32_t>& items);

}  // namespace relievo::test

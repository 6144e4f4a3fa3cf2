// SPDX-License-Identifier: Apache-2.0
// The directory of a ZIP file (PKWARE's APPNOTE), and the content of its members.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/inflate/inflate.h"
#include "platform/files/answered_file.h"

namespace relievo::npz {

struct Member {
  std::string name;
  std::uint64_t begin = 0, end = 0;  // of its content in the file, as it is stored
  bool deflated = false;
};

// The members that are stored or deflated, of the first 1,000 of them. Empty if the directory is damaged or missing.
[[nodiscard]] std::vector<Member> membersOf(const AnsweredFile& file);

// Reads the content of a member, quickly from the front to the end.
class MemberReader {
 public:
  MemberReader(AnsweredFile file, Member member);
  [[nodiscard]] const std::string& name() const noexcept { return member_.name; }
  // Returns the number of bytes; fewer than asked for at the end of the member, or if it is damaged.
  [[nodiscard]] std::size_t read(std::uint64_t at, std::span<std::uint8_t> out);

 private:
  AnsweredFile file_;
  Member member_;
  std::optional<Inflater> inflater_;
  std::uint64_t position_ = 0;  // of what the inflater gives next
};

}  // namespace relievo::npz

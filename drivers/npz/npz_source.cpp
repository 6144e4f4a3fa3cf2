// SPDX-License-Identifier: Apache-2.0
// Media source of a npz file: chooses one of its arrays.
#include <algorithm>
#include <array>
#include <string_view>

#include "drivers/floats/array_source.h"
#include "drivers/npz/archive.h"
#include "drivers/npz/npz.h"
#include "hal/media/media_names.h"
#include "platform/files/byte_reader.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

using npz::Member;
using npz::MemberReader;

constexpr std::string_view kArray = ".npy";

bool isPicture(MemberReader& reader) {
  constexpr std::uint64_t kLeast = 16;  // rows and columns: fewer are a pose or a camera's matrix
  std::array<std::uint8_t, npy::kLongestHeader> begin{};
  const auto header = npy::parseHeader(std::span(begin).first(reader.read(0, begin)));
  return header && std::min(header->rows, header->cols) >= kLeast;
}

// Of names that programmers give, as "predDepth": a part of the word is enough.
bool isOfDepth(const std::string& name) {
  const std::string small = lowerCase(name);
  const auto isIn = [&](std::string_view word) { return small.find(word) != small.npos; };
  constexpr std::array<std::string_view, 6> kOther{"conf", "mask", "valid", "uncert", "std", "color"};
  return std::ranges::any_of(kDepthWords, isIn) && std::ranges::none_of(kOther, isIn);
}

class NpzSource final : public ArraySource {
 public:
  ~NpzSource() override { close(); }

 private:
  Result<void> findArray(const std::string& url, std::map<std::string, std::string>& tags) override {
    const std::vector<Member> members = npz::membersOf(file_);
    if (members.empty()) {
      return fail(ErrorCode::Corrupt,
                  "the archive's end, which lists its arrays, is missing or damaged; copy it again");
    }
    std::vector<Member> pictures;
    for (const Member& member : members) {
      if (isInterrupted()) return fail(ErrorCode::Cancelled, "interrupted");
      MemberReader reader(file_, member);
      if (member.name.ends_with(kArray) && isPicture(reader)) pictures.push_back(member);
    }
    if (pictures.size() > 1) {
      std::vector<Member> named = pictures;
      std::erase_if(named, [](const Member& member) { return !isOfDepth(member.name); });
      if (named.size() == 1) pictures = std::move(named);
    }
    if (pictures.empty()) {
      return fail(
          ErrorCode::Unsupported,
          "this archive has no array that is a picture or a film: rows x columns, or pictures x rows x columns");
    }
    if (pictures.size() > 1) {
      return fail(ErrorCode::Unsupported,
                  "several arrays of this archive may be its depth; unzip it and name the .npy with the depth");
    }
    array_.emplace(file_, pictures.front());
    tags[kFileTag] = url + "/" + array_->name();
    return {};
  }
  std::size_t readArray(std::uint64_t at, std::span<std::uint8_t> out) override { return array_->read(at, out); }
  void closeSource() noexcept override {
    array_.reset();
    ArraySource::closeSource();
  }

  std::optional<MemberReader> array_;
};

}  // namespace

bool isNpz(const std::string& path) {
  constexpr std::string_view kLocal = "PK\3\4";
  constexpr std::size_t kNameLength = 26, kName = 30;
  const auto file = AnsweredFile::open(path);
  std::array<std::uint8_t, 300> begin{};
  const std::size_t got = file ? file->read(0, begin).value_or(0) : 0;
  const std::string_view text(reinterpret_cast<const char*>(begin.data()), got);
  if (got < kName || !text.starts_with(kLocal)) return false;
  return text.substr(kName, ByteReader(std::span(begin).subspan(kNameLength)).value<std::uint16_t>()).ends_with(kArray);
}

std::unique_ptr<MediaSource> makeNpzSource() {
  return std::make_unique<NpzSource>();
}

}  // namespace relievo

// SPDX-License-Identifier: Apache-2.0
// Media source of a npy file, which is one array.
#include "drivers/floats/array_source.h"
#include "drivers/floats/floats.h"

namespace relievo {
namespace {

class NpySource final : public ArraySource {
 public:
  ~NpySource() override { close(); }

 private:
  Result<void> findArray(const std::string&, std::map<std::string, std::string>&) override { return {}; }
  std::size_t readArray(std::uint64_t at, std::span<std::uint8_t> out) override {
    return file_.read(at, out).value_or(0);
  }
};

}  // namespace

bool isNpyFile(const std::string& path) {
  const auto file = AnsweredFile::open(path);
  std::array<std::uint8_t, 16> begin{};
  return file && npy::isNpy(std::span(begin).first(file->read(0, begin).value_or(0)));
}

std::unique_ptr<MediaSource> makeNpySource() {
  return std::make_unique<NpySource>();
}

}  // namespace relievo

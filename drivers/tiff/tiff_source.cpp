// SPDX-License-Identifier: Apache-2.0
// Media source of a TIFF file of several pages: reads one page at a time.
#include <utility>

#include "drivers/floats/counted_source.h"
#include "drivers/tiff/tiff.h"
#include "drivers/tiff/tiff_pages.h"
#include "platform/print.h"

namespace relievo {
namespace {

class TiffSource final : public CountedSource {
 public:
  explicit TiffSource(DescribeFirstPage describe) : describe_(std::move(describe)) {}
  ~TiffSource() override { close(); }

 private:
  Result<Description> describe(const std::string& url) override {
    auto pages = tiff::Pages::of(file_);
    if (const auto failure = file_.failure()) return std::unexpected(*failure);
    if (!pages) return fail(ErrorCode::Corrupt, "is no TIFF of several pages; check the file");
    pages_ = std::move(*pages);
    auto stream = describe_(url);
    if (!stream) return std::unexpected(stream.error());
    stream->index = 0;
    stream->kind = StreamKind::Video;
    stream->counted = true;
    stream->frame_period = kPeriod;
    Description description{.streams = {*std::move(stream)}};
    if (pages_.leftOut() > 0) {
      description.notes.push_back(print("%zu of its %zu pages are left out: they are of another size or type",
                                        pages_.leftOut(), pages_.count() + pages_.leftOut()));
    }
    return description;
  }

  // A page that is damaged is passed over.
  Result<std::optional<Packet>> readPacket() override {
    while (next_ < pages_.count()) {
      if (isInterrupted()) return fail(ErrorCode::Cancelled, "interrupted");
      auto page = pages_.page(file_, static_cast<std::size_t>(next_++));
      if (!page) {
        if (const auto failure = file_.failure()) return std::unexpected(*failure);
        countMissed(1);
        continue;
      }
      return packetOf(std::make_shared<const std::vector<std::uint8_t>>(std::move(*page)));
    }
    return std::nullopt;
  }

  void closeSource() noexcept override {
    CountedSource::closeSource();
    pages_ = {};
  }

  DescribeFirstPage describe_;
  tiff::Pages pages_;
};

}  // namespace

bool isTiffFilm(const std::string& path) {
  const auto file = AnsweredFile::open(path);
  const auto pages = file ? tiff::Pages::of(*file) : std::nullopt;
  return pages && pages->count() > 1;
}

std::unique_ptr<MediaSource> makeTiffSource(DescribeFirstPage describe) {
  return std::make_unique<TiffSource>(std::move(describe));
}

}  // namespace relievo

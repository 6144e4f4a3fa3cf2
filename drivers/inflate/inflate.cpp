// SPDX-License-Identifier: Apache-2.0
#include "drivers/inflate/inflate.h"

#include <algorithm>
#include <utility>

namespace relievo {
namespace {

constexpr std::size_t kInput = 1u << 14;

}  // namespace

Inflater::Inflater(AnsweredFile file, std::uint64_t begin, std::uint64_t end)
    : file_(std::move(file)), at_(begin), end_(end), stream_(new z_stream{}) {
  damaged_ = inflateInit2(stream_.get(), -MAX_WBITS) != Z_OK;
}

// Reads what `from` has not used of its input again.
Inflater::Inflater(const Inflater& from)
    : file_(from.file_), at_(from.at_ - from.stream_->avail_in), end_(from.end_), stream_(new z_stream{}) {
  damaged_ = inflateCopy(stream_.get(), from.stream_.get()) != Z_OK || from.damaged_;
  stream_->avail_in = 0;
}

void Inflater::fill() {
  input_.resize(std::min<std::uint64_t>(kInput, end_ - at_));
  input_.resize(file_.read(at_, input_).value_or(0));
  at_ += input_.size();
  stream_->next_in = input_.data();
  stream_->avail_in = static_cast<uInt>(input_.size());
}

std::size_t Inflater::read(std::span<std::uint8_t> out) {
  stream_->next_out = out.data();
  stream_->avail_out = static_cast<uInt>(out.size());
  for (int status = Z_OK; !damaged_ && stream_->avail_out > 0 && status != Z_STREAM_END;) {
    if (stream_->avail_in == 0) fill();
    status = inflate(stream_.get(), Z_NO_FLUSH);
    damaged_ = status != Z_OK && status != Z_STREAM_END;  // Z_BUF_ERROR: the file ends before the stream does
  }
  return out.size() - stream_->avail_out;
}

}  // namespace relievo

// SPDX-License-Identifier: Apache-2.0
// Turns a film of two views into one of colour and depth: the left view, and depth matched from both.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/stereo/stereo_depth.h"
#include "platform/failure.h"

namespace relievo {

enum class SwapEyes : std::uint8_t { Auto, No, Yes };  // Auto: if the pictures show that they are in the wrong order

class StereoFilm {
 public:
  using Progress = std::function<void(std::uint64_t done, std::optional<std::uint64_t> total)>;

  // Reads the whole film once, or twice if the eyes turn out to be swapped: it is one that can be read again. Fails
  // if the film does not consist of two views, or if they hold no depth; Cancelled when `stop` is set.
  [[nodiscard]] static Outcome<StereoFilm> survey(const SourceOptions& source, const PairReader::Backends& backends,
                                                  SwapEyes swap, const std::atomic<bool>& stop,
                                                  const Progress& progress);

  // The source with its stereo layout filled in: open this one for `withDepth`.
  [[nodiscard]] const SourceOptions& source() const noexcept { return source_; }
  // Describes the film with the depth made from its views.
  [[nodiscard]] FilmInfo described(FilmInfo info) const;
  // The left view and its depth, in place of the two views; call it picture by picture.
  [[nodiscard]] Result<FramePair> withDepth(FramePair views);
  // What was corrected; one line each.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  StereoFilm(SourceOptions source, StereoPlan plan, bool swapped);

  SourceOptions source_;
  StereoDepth depth_;
  bool swapped_;
  bool order_told_ = false;  // which eye's view is which, by the user or by the pictures
  std::vector<std::string> notes_;
};

}  // namespace relievo

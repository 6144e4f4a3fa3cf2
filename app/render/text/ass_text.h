// SPDX-License-Identifier: Apache-2.0
// Text and shapes drawn by libass: fonts through fontconfig, shaping by HarfBuzz, order of mixed scripts by FriBidi.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/render/text/text_picture.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// A script in the form of Advanced SubStation: a head with styles, and lines with times. For one thread.
class AssText {
 public:
  // NotFound if there is no font. `foreign`: the scripts come with films. Of those that take seconds, or show over a
  // thousand lines at once, a part is left out, and lines of over 100 kB or of letters that are larger than the screen;
  // that is logged once a script.
  [[nodiscard]] static Result<AssText> create(bool foreign = false);
  AssText(AssText&&) noexcept;
  AssText& operator=(AssText&&) noexcept;
  ~AssText();

  // Begins a new script without lines.
  void begin(std::string_view head);
  // "ReadOrder,Layer,Style,Name,MarginL,MarginR,MarginV,Effect,Text"; shown from `begin` on for `length`.
  void add(std::string_view line, Duration begin, Duration length);
  void removeLines();
  // Scales the letters; 1 is the size that the script says.
  void setSize(double factor) noexcept;

  // Renders what is shown at `time` to `pictures`: as few pictures as possible, which do not overlap. False if they are
  // the same as last time: `pictures` is then unchanged, unless `anew` is set.
  bool draw(const TextFrame& frame, Duration time, std::vector<TextPicture>& pictures, bool anew = false);

  // After the first letter that no font has was drawn as a box, once: that letter. 0: none.
  [[nodiscard]] char32_t takeMissingLetter() noexcept;

  // Escapes text, so that braces and backslashes have no meaning.
  [[nodiscard]] static std::string escaped(std::string_view text);

 private:
  struct Parts;
  explicit AssText(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace relievo

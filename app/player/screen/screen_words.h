// SPDX-License-Identifier: Apache-2.0
// Renders the on-screen display to pictures.
#pragma once

#include <optional>
#include <vector>

#include "app/player/screen/screen_text.h"
#include "app/render/text/ass_text.h"

namespace relievo {

// Use from one thread. Without a font there are no pictures, which is logged once.
class ScreenWords {
 public:
  // True if the pictures differ from the last ones.
  bool draw(const ScreenContent& content, const TextFrame& frame);
  // Draws the next pictures again, even if they are the same.
  void forget() noexcept { frame_.reset(); }
  [[nodiscard]] const std::vector<TextPicture>& pictures() const noexcept { return pictures_; }
  // As of AssText.
  [[nodiscard]] char32_t takeMissingLetter() noexcept { return text_ ? text_->takeMissingLetter() : U'\0'; }

 private:
  [[nodiscard]] bool ready();
  void drawLines(const std::vector<std::string>& lines, const TextFrame& frame);

  std::optional<AssText> text_;
  bool gave_up_ = false;
  double aspect_ = 0;  // of the script
  ScreenContent drawn_;
  std::optional<TextFrame> frame_;
  std::vector<TextPicture> pictures_;  // each over those before it
};

}  // namespace relievo

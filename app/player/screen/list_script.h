// SPDX-License-Identifier: Apache-2.0
// The list of films as a part of the screen's script, its posters, and which film a mouse is over. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/player/screen/screen_list.h"
#include "app/player/screen/script.h"

namespace relievo {

// The keys that the list's foot names.
struct ListKeys {
  std::string help, choose;  // show all keys; play the selected film
};
void addList(Script& script, const ScreenList& list, const ListKeys& keys);
// The posters of the list's rows, for a view of `frame`, to be drawn over the result of `addList`.
[[nodiscard]] std::vector<TextPicture> postersOf(const ScreenList& list, const TextFrame& frame);
// The film at a place of the view, `across` and `down` from 0 to 1; nullopt if none is there.
[[nodiscard]] std::optional<std::size_t> listFilmAt(const ScreenList& list, double across, double down,
                                                    double aspect) noexcept;
// Whether the foot's words about `help_key` are at this place.
[[nodiscard]] bool isListHelpAt(const std::string& help_key, double across, double down, double aspect);

}  // namespace relievo

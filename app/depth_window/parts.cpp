// SPDX-License-Identifier: Apache-2.0
// Names of the parts.
#include "app/depth_window/parts.h"

#include <array>
#include <utility>

namespace relievo {
namespace {

constexpr std::array<std::pair<const char*, TimeLaw>, 4> kTimeLaws{
    {{"hold", TimeLaw::Hold}, {"linear", TimeLaw::Linear}, {"bspline", TimeLaw::BSpline}, {"fitted", TimeLaw::Fitted}}};
constexpr std::array<std::pair<const char*, SpaceLaw>, 3> kSpaceLaws{
    {{"triangles", SpaceLaw::Triangles}, {"quadratic", SpaceLaw::Quadratic}, {"bspline", SpaceLaw::BSpline}}};

template <class List, class Law>
const char* nameIn(const List& list, Law law) noexcept {
  for (const auto& [word, value] : list) {
    if (value == law) return word;
  }
  return "";
}
template <class Law, class List>
std::optional<Law> findIn(const List& list, std::string_view wanted) noexcept {
  for (const auto& [word, value] : list) {
    if (wanted == word) return value;
  }
  return std::nullopt;
}

}  // namespace

std::optional<TimeLaw> timeLaw(std::string_view wanted) noexcept {
  return findIn<TimeLaw>(kTimeLaws, wanted);
}
const char* name(TimeLaw law) noexcept {
  return nameIn(kTimeLaws, law);
}
std::optional<SpaceLaw> spaceLaw(std::string_view wanted) noexcept {
  return findIn<SpaceLaw>(kSpaceLaws, wanted);
}
const char* name(SpaceLaw law) noexcept {
  return nameIn(kSpaceLaws, law);
}

}  // namespace relievo

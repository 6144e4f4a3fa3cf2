// SPDX-License-Identifier: Apache-2.0
// On which machine and day a chart was measured, and whether quickly.
#pragma once

#include <string>
#include <string_view>

namespace relievo {

// "Xeon E5-2680, 2026-03-01, quick run": here and now.
[[nodiscard]] std::string occasionNow(bool quick);
[[nodiscard]] bool isOfQuickRun(std::string_view occasion) noexcept;

}  // namespace relievo

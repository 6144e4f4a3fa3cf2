// SPDX-License-Identifier: Apache-2.0
// The name of a back end under a contract, for the last argument of INSTANTIATE_TEST_SUITE_P.
#pragma once

#include <string>

namespace relievo::test {

inline constexpr auto kBackendName = [](const auto& test) { return std::string(test.param.name); };

}  // namespace relievo::test

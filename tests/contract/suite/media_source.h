// SPDX-License-Identifier: Apache-2.0
// The contract of every media source: states, one final end, packets that outlive it, seeking to key frames. List the
// back ends in a test of your own: INSTANTIATE_TEST_SUITE_P(Backends, MediaSourceContract, testing::Values(..),
// test::kBackendName).
#pragma once

#include "tests/contract/suite/film.h"

namespace relievo {

class MediaSourceContract : public test::FilmContract {
 protected:
  using State = MediaSource::State;
};

namespace test {

// Links the suite's cases to whoever includes this header: of a static library only what somebody names is linked.
[[nodiscard]] bool mediaSourceCases();
inline const bool kMediaSourceCases = mediaSourceCases();

}  // namespace test
}  // namespace relievo

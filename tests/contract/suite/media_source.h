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

// Of a static library the linker takes only what is referenced. This reference brings the suite's cases into every
// program that includes this header.
[[nodiscard]] bool mediaSourceCases();
inline const bool kMediaSourceCases = mediaSourceCases();

}  // namespace test
}  // namespace relievo

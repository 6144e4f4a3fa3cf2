// SPDX-License-Identifier: Apache-2.0
#include "app/media/back_off.h"

#include <gtest/gtest.h>

namespace relievo {
namespace {

using namespace std::chrono_literals;

TEST(BackOff, MissesWhatComesBackByNoMoreThanAnEighthOfItsAbsence) {
  const MonotonicTime lost(100s);
  BackOff back_off;
  back_off.begin(lost);
  EXPECT_EQ(back_off.next(), lost + 250ms);
  int tries = 0;
  for (MonotonicTime now = back_off.next(); back_off.away(now) < 30s; ++tries) {
    back_off.failed(now);
    EXPECT_LE(back_off.next() - now, std::max<Duration>(250ms, (now - lost) / 8)) << tries;
    EXPECT_GE(back_off.next() - now, 250ms) << tries;
    now = back_off.next();
  }
  EXPECT_LT(tries, 40);
  back_off.failed(lost + 1h);
  EXPECT_EQ(back_off.next(), lost + 1h + 4s);
  back_off.begin(lost + 2h);
  EXPECT_EQ(back_off.next(), lost + 2h + 250ms);
}

}  // namespace
}  // namespace relievo

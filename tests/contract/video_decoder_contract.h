// SPDX-License-Identifier: Apache-2.0
// The contract of every video decoder, and the film for back ends that decode H.264. A test program includes it and
// lists its back ends.
#pragma once

#include "tests/contract/films.h"
#include "tests/contract/state_table.h"
#include "tests/contract/suite/video_decoder.h"

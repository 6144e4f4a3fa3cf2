// SPDX-License-Identifier: Apache-2.0
// An option of the command line that names a back end.
#pragma once

#include "hal/back_end_name.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
class Option;
}  // namespace CLI

namespace relievo {

// An option that names a back end. Its word is one of `names`: those stand parted by spaces, each with what may follow
// it in brackets or behind a colon. `second`: it may be given twice; null: once.
CLI::Option* addBackEnd(CLI::App& command, const char* option, BackEndName& chosen, const char* kind, const char* names,
                        const char* help, BackEndName* second = nullptr);

}  // namespace relievo

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glib.h>

namespace relievo::test {

// Ends a loop that another thread runs, or is about to run: told from outside, one that does not run yet would run for
// ever.
inline void quitLoop(GMainLoop* loop) {
  GSource* const last = g_idle_source_new();
  const GSourceFunc quit = [](gpointer told) -> gboolean {
    g_main_loop_quit(static_cast<GMainLoop*>(told));
    return G_SOURCE_REMOVE;
  };
  g_source_set_callback(last, quit, loop, nullptr);
  g_source_attach(last, g_main_loop_get_context(loop));
  g_source_unref(last);
}

}  // namespace relievo::test

// SPDX-License-Identifier: Apache-2.0
// A thread that answers the ioctl requests of a node that umockdev simulates.
#pragma once

#include <umockdev.h>

#include <functional>
#include <thread>

namespace relievo::test {

// Runs as long as this lives. Make it the last member of its owner, so that it is destroyed first.
class RequestLoop {
 public:
  // `answer` completes the request, or returns false.
  explicit RequestLoop(std::function<bool(UMockdevIoctlClient*)> answer) : answer_(std::move(answer)) {
    g_main_context_push_thread_default(context_);
    handler_ = umockdev_ioctl_base_new();
    g_main_context_pop_thread_default(context_);
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(onRequest), this);
    thread_ = std::thread([this] {
      g_main_context_push_thread_default(context_);
      g_main_loop_run(loop_);
      g_main_context_pop_thread_default(context_);
    });
  }
  ~RequestLoop() {
    end();
    g_object_unref(handler_);
    g_main_loop_unref(loop_);
    g_main_context_unref(context_);
  }
  // Stops answering. The quit runs inside the loop: from outside, a loop that has not started yet would run forever.
  void end() {
    if (!thread_.joinable()) return;
    GSource* const last = g_idle_source_new();
    const GSourceFunc quit = [](gpointer loop) -> gboolean {
      g_main_loop_quit(static_cast<GMainLoop*>(loop));
      return G_SOURCE_REMOVE;
    };
    g_source_set_callback(last, quit, loop_, nullptr);
    g_source_attach(last, context_);
    g_source_unref(last);
    thread_.join();
  }
  RequestLoop(const RequestLoop&) = delete;
  RequestLoop& operator=(const RequestLoop&) = delete;

  // For umockdev_testbed_attach_ioctl.
  [[nodiscard]] UMockdevIoctlBase* handler() const { return handler_; }

 private:
  static gboolean onRequest(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    return static_cast<RequestLoop*>(self)->answer_(client) ? TRUE : FALSE;
  }

  std::function<bool(UMockdevIoctlClient*)> answer_;
  GMainContext* context_ = g_main_context_new();
  GMainLoop* loop_ = g_main_loop_new(context_, FALSE);
  UMockdevIoctlBase* handler_ = nullptr;
  std::thread thread_;
};

}  // namespace relievo::test

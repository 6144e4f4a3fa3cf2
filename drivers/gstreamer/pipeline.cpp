// SPDX-License-Identifier: Apache-2.0
// appsrc ! parser ! decoder ! appsink. A stop and a flush wait for the element's threads, so they run on another
// thread, which is left behind if the element hangs.
#include "drivers/gstreamer/pipeline.h"

#include <gst/app/gstappsink.h>
#include <gst/app/gstappsrc.h>
#include <gst/video/gstvideometa.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "drivers/gstreamer/picture.h"
#include "platform/log.h"

namespace relievo::gstreamer {
namespace {

constexpr std::chrono::milliseconds kStopPatience{300}, kDrainPatience{200};

constexpr const char* kNoStart = "the GStreamer element does not start; is its device free?";
constexpr const char* kGone = "the GStreamer element's device has gone";
constexpr const char* kFailed = "the GStreamer element failed";
constexpr const char* kNotItsKind = "the GStreamer element cannot decode this kind of stream";

// Stops a pipeline on a thread of GStreamer's. It first waits for the end of the stream: the decoders of gst-libav 1.26
// use freed memory if they are stopped while they drain.
struct Stop {
  GstAppSink* draining;  // null: the stream goes on
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;

  static void run(GstElement* pipeline, gpointer given) {
    Stop& stopping = **static_cast<std::shared_ptr<Stop>*>(given);
    if (stopping.draining != nullptr) letEnd(*stopping.draining);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    const std::lock_guard lock(stopping.mutex);
    stopping.done = true;
    stopping.changed.notify_all();
  }
  static void letEnd(GstAppSink& sink) {
    const auto until = std::chrono::steady_clock::now() + kDrainPatience;
    while (gst_app_sink_is_eos(&sink) != TRUE && std::chrono::steady_clock::now() < until) {
      const SamplePtr picture(gst_app_sink_try_pull_sample(&sink, GST_MSECOND));
    }
  }
  static void forget(gpointer given) { delete static_cast<std::shared_ptr<Stop>*>(given); }
};

// Tells the decoder that its reader accepts padded rows, crops the pictures itself, and keeps a number of buffers.
GstPadProbeReturn answerAllocation(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstQuery* const query = GST_PAD_PROBE_INFO_QUERY(info);
  if (GST_QUERY_TYPE(query) != GST_QUERY_ALLOCATION) return GST_PAD_PROBE_OK;
  GstCaps* caps = nullptr;
  gst_query_parse_allocation(query, &caps, nullptr);
  GstVideoInfo video;
  if (caps == nullptr || gst_video_info_from_caps(&video, caps) != TRUE) return GST_PAD_PROBE_OK;
  gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
  gst_query_add_allocation_meta(query, GST_VIDEO_CROP_META_API_TYPE, nullptr);
  gst_query_add_allocation_pool(query, nullptr, static_cast<guint>(GST_VIDEO_INFO_SIZE(&video)),
                                kPicturesWaiting + kPicturesHeld, 0);
  return GST_PAD_PROBE_HANDLED;
}

void setIfThere(GstElement* element, const char* property, gboolean value) {
  if (g_object_class_find_property(G_OBJECT_GET_CLASS(element), property) != nullptr) {
    g_object_set(element, property, value, nullptr);
  }
}

GstElement* makeSource(const GstCaps& caps) {
  GstElement* const source = gst_element_factory_make("appsrc", nullptr);
  if (source == nullptr) return nullptr;
  g_object_set(source, "caps", &caps, "format", GST_FORMAT_TIME, "max-bytes", guint64{0}, nullptr);
  return source;
}

GstElement* makeSink() {
  GstElement* const sink = gst_element_factory_make("appsink", nullptr);
  if (sink == nullptr) return nullptr;
  const CapsPtr readable = readableCaps();
  g_object_set(sink, "sync", FALSE, "async", FALSE, "wait-on-eos", FALSE, "enable-last-sample", FALSE, "max-buffers",
               guint{kPicturesWaiting}, "caps", readable.get(), nullptr);
  const PadPtr pad(gst_element_get_static_pad(sink, "sink"));
  gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM, answerAllocation, nullptr, nullptr);
  return sink;
}

bool isOfFlow(GstMessage& message, GstFlowReturn wanted) {
  const GstStructure* details = nullptr;
  gst_message_parse_error_details(&message, &details);
  gint flow = 0;
  return details != nullptr && gst_structure_get_int(details, "flow-return", &flow) == TRUE && flow == wanted;
}

Error errorOf(GstMessage& message) {
  GError* told = nullptr;
  gst_message_parse_error(&message, &told, nullptr);
  log(LogLevel::Info, "media", "GStreamer, %s: %s", GST_OBJECT_NAME(GST_MESSAGE_SRC(&message)), told->message);
  const bool resource = told->domain == GST_RESOURCE_ERROR, stream = told->domain == GST_STREAM_ERROR;
  const int code = told->code;
  g_error_free(told);
  if (resource && (code == GST_RESOURCE_ERROR_NOT_FOUND || code == GST_RESOURCE_ERROR_OPEN_READ_WRITE)) {
    return {ErrorCode::Lost, 0, kGone};
  }
  const bool other_kind = stream && (code == GST_STREAM_ERROR_WRONG_TYPE || code == GST_STREAM_ERROR_FORMAT ||
                                     code == GST_STREAM_ERROR_CODEC_NOT_FOUND);
  if (other_kind || isOfFlow(message, GST_FLOW_NOT_NEGOTIATED)) return {ErrorCode::Unsupported, 0, kNotItsKind};
  return {ErrorCode::Io, 0, kFailed};
}

}  // namespace

Result<std::unique_ptr<Pipeline>> Pipeline::make(const Coding& coding, GstElementFactory& decoder, CapsPtr caps) {
  std::unique_ptr<Pipeline> made(new Pipeline);
  made->caps_ = std::move(caps);
  if (!made->build(coding, decoder) || !made->run()) return fail(ErrorCode::Io, kNoStart);
  return made;
}

bool Pipeline::build(const Coding& coding, GstElementFactory& decoder) {
  pipeline_.reset(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new(nullptr))));
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_.get()), nullptr);
  bus_.reset(gst_element_get_bus(pipeline_.get()));
  source_ = makeSource(*caps_);
  sink_ = makeSink();
  GstElement* const parser = coding.parser == nullptr ? nullptr : gst_element_factory_make(coding.parser, nullptr);
  GstElement* const element = gst_element_factory_create(&decoder, nullptr);
  GstElement* last = nullptr;
  bool linked = source_ != nullptr && sink_ != nullptr && element != nullptr;
  for (GstElement* const each : {source_, parser, element, sink_}) {
    if (each == nullptr) continue;
    gst_bin_add(GST_BIN(pipeline_.get()), each);
    linked = linked && (last == nullptr || gst_element_link(last, each) == TRUE);
    last = each;
  }
  if (element != nullptr) setIfThere(element, "discard-corrupted-frames", TRUE);
  return linked;
}

Pipeline::~Pipeline() {
  if (pipeline_) static_cast<void>(stop());
}

bool Pipeline::run() {
  return gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) != GST_STATE_CHANGE_FAILURE;
}

void Pipeline::push(BufferPtr packet) {
  gst_app_src_push_buffer(GST_APP_SRC(source_), packet.release());
}

void Pipeline::end() {
  draining_ = true;
  gst_app_src_end_of_stream(GST_APP_SRC(source_));
}

SamplePtr Pipeline::pull(Duration longest) {
  return SamplePtr(gst_app_sink_try_pull_sample(GST_APP_SINK(sink_), static_cast<GstClockTime>(longest.count())));
}

bool Pipeline::ended() const {
  return gst_app_sink_is_eos(GST_APP_SINK(sink_)) == TRUE;
}

std::size_t Pipeline::waiting() const {
  return gst_app_src_get_current_level_buffers(GST_APP_SRC(source_));
}

std::optional<Error> Pipeline::failure() {
  if (failure_) return failure_;
  const MessagePtr message(gst_bus_pop_filtered(bus_.get(), GST_MESSAGE_ERROR));
  if (message) failure_ = errorOf(*message);
  return failure_;
}

bool Pipeline::stop() {
  if (left_behind_) return false;
  const auto stopping = std::make_shared<Stop>(draining_ && !hangs_ && !failure_ ? GST_APP_SINK(sink_) : nullptr);
  gst_element_call_async(pipeline_.get(), Stop::run, new std::shared_ptr<Stop>(stopping), Stop::forget);
  std::unique_lock lock(stopping->mutex);
  const auto patience = hangs_ ? std::chrono::milliseconds(0) : kStopPatience;
  if (stopping->changed.wait_for(lock, patience, [&] { return stopping->done; })) return true;
  left_behind_ = true;
  return false;
}

}  // namespace relievo::gstreamer

// SPDX-License-Identifier: Apache-2.0
// A bin around avdec_h264; a probe on its output makes the faults.
#include "tests/support/device/gstreamer_element.h"

#include <gst/allocators/gstdmabuf.h>
#include <gst/gst.h>
#include <gst/video/video.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>

namespace relievo::test {
namespace {

struct Switches {
  std::mutex mutex;
  std::condition_variable released, hung;
  GstreamerElement::Fault fault = GstreamerElement::Fault::None;
  int after = 0, times = 0, pictures = 0, instances = 0;
  std::atomic<int> live = 0;
  bool release = true, hangs = false, dma_bufs = false;
};
Switches& switches() {
  static Switches all;
  return all;
}

// The same samples in memory with a file descriptor.
GstBuffer* inDmaBuf(GstBuffer* picture) {
  const gsize bytes = gst_buffer_get_size(picture);
  const int fd = ::memfd_create("picture", MFD_CLOEXEC);
  if (fd < 0 || ::ftruncate(fd, static_cast<off_t>(bytes)) != 0) std::abort();
  GstAllocator* const allocator = gst_dmabuf_allocator_new();
  GstBuffer* const copy = gst_buffer_new();
  gst_buffer_append_memory(copy, gst_dmabuf_allocator_alloc(allocator, fd, bytes));
  gst_object_unref(allocator);
  GstMapInfo map;
  gst_buffer_map(copy, &map, GST_MAP_WRITE);
  gst_buffer_extract(picture, 0, map.data, bytes);
  gst_buffer_unmap(copy, &map);
  if (GstVideoMeta* const meta = gst_buffer_get_video_meta(picture); meta != nullptr) {
    gst_buffer_add_video_meta_full(copy, meta->flags, meta->format, meta->width, meta->height, meta->n_planes,
                                   meta->offset, meta->stride);
  }
  const int flags = GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS;
  gst_buffer_copy_into(copy, picture, static_cast<GstBufferCopyFlags>(flags), 0, static_cast<gsize>(-1));
  return copy;
}

GstPadProbeReturn onPicture(GstPad* pad, GstPadProbeInfo* info, gpointer) {
  Switches& all = switches();
  std::unique_lock lock(all.mutex);
  GstElement* const element = GST_PAD_PARENT(pad);
  if (g_object_get_data(G_OBJECT(element), "befallen") != nullptr) return GST_PAD_PROBE_DROP;
  const bool befalls = all.times > 0 && all.pictures >= all.after;
  if (befalls && all.fault == GstreamerElement::Fault::Pauses) {
    --all.times;
    all.released.wait_for(lock, std::chrono::milliseconds(1200), [&] { return all.release; });
  } else if (befalls) {
    --all.times;
    g_object_set_data(G_OBJECT(element), "befallen", &all);
    switch (all.fault) {
      case GstreamerElement::Fault::Hangs:
        all.hangs = true;
        all.hung.notify_all();
        all.released.wait(lock, [&] { return all.release; });
        break;
      case GstreamerElement::Fault::Fails:
        GST_ELEMENT_ERROR(element, STREAM, DECODE, ("a test's failure"), (nullptr));
        break;
      case GstreamerElement::Fault::IsGone:
        GST_ELEMENT_ERROR(element, RESOURCE, NOT_FOUND, ("a test's lost device"), (nullptr));
        break;
      case GstreamerElement::Fault::Pauses:
      case GstreamerElement::Fault::None:
        break;
    }
    return GST_PAD_PROBE_DROP;
  }
  ++all.pictures;
  if (all.dma_bufs) {
    GstBuffer* const picture = GST_PAD_PROBE_INFO_BUFFER(info);
    info->data = inDmaBuf(picture);
    gst_buffer_unref(picture);
  }
  ++all.live;
  gst_mini_object_weak_ref(
      GST_MINI_OBJECT_CAST(info->data), [](gpointer, GstMiniObject*) { --switches().live; }, nullptr);
  return GST_PAD_PROBE_OK;
}

using TestH264 = GstBin;
using TestH264Class = GstBinClass;
G_DEFINE_TYPE(TestH264, test_h264, GST_TYPE_BIN)

void test_h264_class_init(TestH264Class* type) {
  GstElementClass* const element = GST_ELEMENT_CLASS(type);
  gst_element_class_set_static_metadata(element, "a decoder that is not there", "Codec/Decoder/Video/Hardware",
                                        "FFmpeg's, with faults", "relievo");
  static GstStaticPadTemplate sink =
      GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS,
                              GST_STATIC_CAPS("video/x-h264, stream-format={avc, byte-stream}, alignment=au"));
  static GstStaticPadTemplate source =
      GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw"));
  gst_element_class_add_static_pad_template(element, &sink);
  gst_element_class_add_static_pad_template(element, &source);
}

void test_h264_init(TestH264* bin) {
  GstElement* const inner = gst_element_factory_make("avdec_h264", nullptr);
  gst_bin_add(GST_BIN(bin), inner);
  for (const char* const name : {"sink", "src"}) {
    GstPad* const pad = gst_element_get_static_pad(inner, name);
    if (name[1] == 'r') gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, onPicture, nullptr, nullptr);
    gst_element_add_pad(GST_ELEMENT(bin), gst_ghost_pad_new(name, pad));
    gst_object_unref(pad);
  }
  const std::lock_guard lock(switches().mutex);
  ++switches().instances;
  ++switches().live;
  g_object_weak_ref(G_OBJECT(bin), [](gpointer, GObject*) { --switches().live; }, nullptr);
}

using TestSoftware = GstBin;
using TestSoftwareClass = GstBinClass;
G_DEFINE_TYPE(TestSoftware, test_software, test_h264_get_type())

void test_software_class_init(TestSoftwareClass* type) {
  gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(type), "a decoder in software", "Codec/Decoder/Video",
                                        "FFmpeg's, with faults", "relievo");
  static GstStaticPadTemplate source =
      GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw, format={NV12, I420}"));
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(type), &source);
}
void test_software_init(TestSoftware*) {}

}  // namespace

GstreamerElement::GstreamerElement() {
  gst_init(nullptr, nullptr);
  static const bool once =
      gst_element_register(nullptr, kName, GST_RANK_PRIMARY + 1000, test_h264_get_type()) == TRUE &&
      gst_element_register(nullptr, kSoftware, GST_RANK_MARGINAL, test_software_get_type()) == TRUE &&
      gst_element_register(nullptr, kMakers, GST_RANK_MARGINAL, test_software_get_type()) == TRUE;
  if (!once) std::abort();
  const std::lock_guard lock(switches().mutex);
  switches().times = switches().instances = 0;
  switches().dma_bufs = false;
}

GstreamerElement::~GstreamerElement() {
  const std::lock_guard lock(switches().mutex);
  switches().times = 0;
  switches().release = true;
  switches().released.notify_all();
}

void GstreamerElement::befall(Fault fault, int after, int times) {
  const std::lock_guard lock(switches().mutex);
  switches().fault = fault;
  switches().after = after;
  switches().times = times;
  switches().pictures = 0;
  switches().release = switches().hangs = false;
}

void GstreamerElement::awaitHang() {
  std::unique_lock lock(switches().mutex);
  switches().hung.wait(lock, [] { return switches().hangs; });
}

void GstreamerElement::useDmaBufs() {
  const std::lock_guard lock(switches().mutex);
  switches().dma_bufs = true;
}

int GstreamerElement::instances() const {
  const std::lock_guard lock(switches().mutex);
  return switches().instances;
}

int GstreamerElement::live() const {
  return switches().live;
}

void keepGstreamerListAt(const std::string& path) {
  ::setenv("GST_REGISTRY", path.c_str(), 1);
  ::unsetenv("GST_PLUGIN_SYSTEM_PATH_1_0");
}

}  // namespace relievo::test

// SPDX-License-Identifier: Apache-2.0
// Hardware elements say so in their class ("Codec/Decoder/Video/Hardware"), except for some of makers. One of rank
// "none" is not chosen.
#include "drivers/gstreamer/elements.h"

#include <glob.h>
#include <gst/video/video.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "drivers/gstreamer/gstreamer.h"

namespace relievo {
namespace gstreamer {
namespace {

constexpr const char* kUnknown =
    "there is no such GStreamer element here; gst-inspect-1.0 lists those that are installed";
constexpr const char* kOtherCodec = "that GStreamer element does not take this codec; name another one";
constexpr const char* kFewerBits =
    "that GStreamer element gives pictures of fewer bits than the film's; name another one";

// V4L2 and its request API, DRM and VA-API, Rockchip, NVIDIA, Amlogic.
constexpr std::array kNodes{"/dev/media[0-9]*",  "/dev/video[0-9]*",  "/dev/dri/renderD*",
                            "/dev/mpp_service*", "/dev/nvidia[0-9]*", "/dev/amvideo*"};

// Of Rockchip ("Decoder/Video"), NXP ("Codec/Decoder/Video") and Qualcomm ("Decoder/Video").
constexpr std::array kMakersElements{"mppvideodec", "vpudec", "qtic2vdec"};

std::vector<FactoryPtr> hardware() {
  constexpr GstElementFactoryListType kDecoders =
      GST_ELEMENT_FACTORY_TYPE_DECODER | GST_ELEMENT_FACTORY_TYPE_MEDIA_VIDEO;
  FeatureListPtr all(gst_element_factory_list_get_elements(kDecoders, GST_RANK_MARGINAL));
  all.reset(g_list_sort(all.release(), gst_plugin_feature_rank_compare_func));
  std::vector<FactoryPtr> found;
  for (const GList* each = all.get(); each != nullptr; each = each->next) {
    auto* const factory = static_cast<GstElementFactory*>(each->data);
    if (isHardware(*factory)) found.emplace_back(GST_ELEMENT_FACTORY(gst_object_ref(factory)));
  }
  return found;
}

bool takes(GstElementFactory& factory, const Coding& coding) {
  const CapsPtr caps(gst_caps_from_string(coding.media_type));
  return gst_element_factory_can_sink_any_caps(&factory, caps.get()) == TRUE;
}

// Whether a description of formats, which is a name, a list of names, or null for all, holds one of so many bits.
bool hasBits(const GValue* formats, int bits) {
  if (formats != nullptr && G_VALUE_HOLDS_STRING(formats)) {
    const auto format = gst_video_format_from_string(g_value_get_string(formats));
    const GstVideoFormatInfo* const info = gst_video_format_get_info(format);
    const int depth = info == nullptr ? 0 : static_cast<int>(GST_VIDEO_FORMAT_INFO_DEPTH(info, 0));
    return depth == 0 || depth >= bits;  // 0: not said, as by the modifiers of a dma-buf (DMA_DRM)
  }
  if (formats == nullptr || !GST_VALUE_HOLDS_LIST(formats)) return true;
  for (guint i = 0; i < gst_value_list_get_size(formats); ++i) {
    if (hasBits(gst_value_list_get_value(formats, i), bits)) return true;
  }
  return false;
}

// False if the element names its formats and all have fewer bits.
bool givesBits(GstElementFactory& factory, int bits) {
  for (const GList* each = gst_element_factory_get_static_pad_templates(&factory); each != nullptr; each = each->next) {
    auto* const pad = static_cast<GstStaticPadTemplate*>(each->data);
    if (pad->direction != GST_PAD_SRC) continue;
    const CapsPtr caps(gst_static_pad_template_get_caps(pad));
    bool some = gst_caps_is_any(caps.get()) == TRUE;
    for (guint i = 0; i < gst_caps_get_size(caps.get()); ++i) {
      some = some || hasBits(gst_structure_get_value(gst_caps_get_structure(caps.get(), i), "format"), bits);
    }
    if (!some) return false;
  }
  return true;
}

Result<void> loadOnce() {
  gst_segtrap_set_enabled(FALSE);  // fatal signals have handlers already
  if (gst_init_check(nullptr, nullptr, nullptr) == TRUE) return {};
  return fail(ErrorCode::Io, "GStreamer cannot be loaded; check its installation with gst-inspect-1.0");
}

}  // namespace

Result<void> load() {
  static const Result<void> loaded = loadOnce();
  return loaded;
}

bool isHardware(GstElementFactory& factory) noexcept {
  const char* const kind = gst_element_factory_get_metadata(&factory, GST_ELEMENT_METADATA_KLASS);
  if (kind != nullptr && std::strstr(kind, "Hardware") != nullptr) return true;
  const auto is = [&](const char* name) { return std::strcmp(GST_OBJECT_NAME(&factory), name) == 0; };
  return std::ranges::any_of(kMakersElements, is);
}

Result<std::vector<FactoryPtr>> decodersFor(const Coding& coding, int bits, const std::string& element) {
  std::vector<FactoryPtr> found;
  if (!element.empty()) {
    found.emplace_back(gst_element_factory_find(element.c_str()));
    if (!found.front()) return fail(ErrorCode::Unsupported, kUnknown);
    if (!takes(*found.front(), coding)) return fail(ErrorCode::Unsupported, kOtherCodec);
    if (!givesBits(*found.front(), bits)) return fail(ErrorCode::Unsupported, kFewerBits);
    return found;
  }
  found = hardware();
  std::erase_if(found, [&](const FactoryPtr& each) { return !takes(*each, coding); });
  if (found.empty()) return fail(ErrorCode::NotFound, "GStreamer has no hardware element for this codec");
  std::erase_if(found, [&](const FactoryPtr& each) { return !givesBits(*each, bits); });
  if (found.empty()) return fail(ErrorCode::Unsupported, "GStreamer's hardware gives pictures of fewer bits");
  return found;
}

}  // namespace gstreamer

bool gstreamerHasDevices() {
  return std::ranges::any_of(gstreamer::kNodes, [](const char* pattern) {
    glob_t found{};
    const bool any = ::glob(pattern, GLOB_NOSORT, nullptr, &found) == 0;
    ::globfree(&found);
    return any;
  });
}

std::vector<GstreamerElement> lookAtGstreamerElements() {
  std::vector<GstreamerElement> seen;
  if (!gstreamer::load()) return seen;
  for (const gstreamer::FactoryPtr& each : gstreamer::hardware()) {
    seen.push_back(
        {GST_OBJECT_NAME(each.get()), gst_element_factory_get_metadata(each.get(), GST_ELEMENT_METADATA_LONGNAME)});
  }
  return seen;
}

}  // namespace relievo

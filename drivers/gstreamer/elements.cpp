// SPDX-License-Identifier: Apache-2.0
// Hardware elements say so in their class ("Codec/Decoder/Video/Hardware"). One of rank "none" is not chosen.
#include "drivers/gstreamer/elements.h"

#include <glob.h>

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

// V4L2 and its request API, DRM and VA-API, Rockchip, NVIDIA, Amlogic.
constexpr std::array kNodes{"/dev/media[0-9]*",  "/dev/video[0-9]*",  "/dev/dri/renderD*",
                            "/dev/mpp_service*", "/dev/nvidia[0-9]*", "/dev/amvideo*"};

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
  return kind != nullptr && std::strstr(kind, "Hardware") != nullptr;
}

Result<std::vector<FactoryPtr>> decodersFor(const Coding& coding, const std::string& element) {
  std::vector<FactoryPtr> found;
  if (!element.empty()) {
    found.emplace_back(gst_element_factory_find(element.c_str()));
    if (!found.front()) return fail(ErrorCode::Unsupported, kUnknown);
    if (!takes(*found.front(), coding)) return fail(ErrorCode::Unsupported, kOtherCodec);
    return found;
  }
  found = hardware();
  std::erase_if(found, [&](const FactoryPtr& each) { return !takes(*each, coding); });
  if (found.empty()) return fail(ErrorCode::NotFound, "GStreamer has no hardware element for this codec");
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

// SPDX-License-Identifier: Apache-2.0
// Owners of GStreamer's objects.
#pragma once

#include <gst/gst.h>

#include <memory>

namespace relievo::gstreamer {

struct ObjectDeleter {
  void operator()(gpointer object) const noexcept { gst_object_unref(object); }
};
struct MiniObjectDeleter {
  template <class T>
  void operator()(T* object) const noexcept {
    gst_mini_object_unref(GST_MINI_OBJECT_CAST(object));
  }
};
struct FeatureListDeleter {
  void operator()(GList* list) const noexcept { gst_plugin_feature_list_free(list); }
};
using ElementPtr = std::unique_ptr<GstElement, ObjectDeleter>;
using FactoryPtr = std::unique_ptr<GstElementFactory, ObjectDeleter>;
using PadPtr = std::unique_ptr<GstPad, ObjectDeleter>;
using BusPtr = std::unique_ptr<GstBus, ObjectDeleter>;
using CapsPtr = std::unique_ptr<GstCaps, MiniObjectDeleter>;
using SamplePtr = std::unique_ptr<GstSample, MiniObjectDeleter>;
using BufferPtr = std::unique_ptr<GstBuffer, MiniObjectDeleter>;
using MessagePtr = std::unique_ptr<GstMessage, MiniObjectDeleter>;
using FeatureListPtr = std::unique_ptr<GList, FeatureListDeleter>;

}  // namespace relievo::gstreamer

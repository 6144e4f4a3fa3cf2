// SPDX-License-Identifier: Apache-2.0
// GStreamer elements that call themselves hardware, made of FFmpeg's, with faults that a test switches.
#pragma once

#include <string>

namespace relievo::test {

// Registers the element "relievotesth264", of a high rank, in this process, a test that wants it alone by rank gets it;
// kSoftware, the same in software, of 8 bits; and kMakers, that one by the name of a maker's.
class GstreamerElement {
 public:
  enum class Fault { None, Hangs, Fails, IsGone, Pauses };  // Pauses: for longer than hardware may

  GstreamerElement();
  // Ends every hang, so that GStreamer's threads go.
  ~GstreamerElement();
  GstreamerElement(const GstreamerElement&) = delete;
  GstreamerElement& operator=(const GstreamerElement&) = delete;

  // Makes the fault after so many pictures, counted from here over all instances of the element; `times`: in so many
  // instances.
  void befall(Fault fault, int after, int times);
  // Returns when an instance hangs.
  void awaitHang();
  // Pictures are in dma-bufs (memory that is described as such).
  void useDmaBufs();
  [[nodiscard]] int instances() const;
  // The instances and pictures in the whole process that still exist.
  [[nodiscard]] int live() const;

  static constexpr const char *kName = "relievotesth264", *kSoftware = "relievotestsoftware", *kMakers = "mppvideodec";
};

// Lets this process see the machine's elements; their list is kept at `path`, not in the user's home. Before GStreamer
// is loaded.
void keepGstreamerListAt(const std::string& path);

}  // namespace relievo::test

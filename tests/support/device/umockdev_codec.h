// SPDX-License-Identifier: Apache-2.0
// A simulated hardware decoder: a node of /dev that follows the kernel's specification of stateful decoders, with
// FFmpeg doing the decoding. Only under `umockdev-wrapper`.
#pragma once

#include <linux/videodev2.h>
#include <umockdev.h>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tests/support/device/request_loop.h"

namespace relievo::test {

struct CodecKind {
  std::uint32_t packets = V4L2_PIX_FMT_H264;
  std::uint32_t pictures = V4L2_PIX_FMT_NV12;   // or YUV420; with `planes` NV12M
  bool planes = false;                          // the multi-planar interface
  bool exports = false;                         // dma-bufs, valid only in this process
  std::uint32_t needed = 4;                     // buffers of pictures
  std::uint32_t row_padding = 0;                // bytes
  std::uint32_t smallest = 16, largest = 4096;  // pixels, across and down
  bool main_profile_only = false;               // of H.264
  bool selects = true;                          // tells the visible part
  bool silent = false;    // tells no size that is the one of the packets' format, as bcm2835-codec
  bool waits = false;     // decodes nothing before the buffers of pictures run, as older venus
  std::size_t ahead = 0;  // pictures that it decodes before it has buffers for them
};

struct CodecLibrary;

class UmockdevCodec {
 public:
  // Creates the node /dev/videoN.
  UmockdevCodec(UMockdevTestbed* bed, int number, CodecKind kind = {});
  ~UmockdevCodec();
  UmockdevCodec(const UmockdevCodec&) = delete;
  UmockdevCodec& operator=(const UmockdevCodec&) = delete;

  // It hangs after that many pictures until it is closed; `times` in a row.
  void hangAfter(int pictures, int times);
  void unplugAfter(int pictures);

  // The number of openings since it was plugged in.
  [[nodiscard]] int openings();
  [[nodiscard]] int pictures();
  [[nodiscard]] int drains();
  // The number of picture buffers that it has.
  [[nodiscard]] int empty();
  // The number of unsupported requests.
  [[nodiscard]] int unknownRequests();

 private:
  struct Size {
    std::uint32_t width = 0, height = 0;
    bool operator==(const Size&) const = default;
  };
  static constexpr Size kUntold{16, 16};  // until the stream states it
  struct Done {
    std::uint32_t index, bytes, flags;
    std::uint64_t tag;
  };
  struct Packet {
    std::uint32_t index, bytes;
    std::uint64_t tag;
  };
  static constexpr std::uint32_t kPage = 4096;
  static constexpr std::uint32_t wholePages(std::uint32_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }
  bool answer(UMockdevIoctlClient* client);
  [[nodiscard]] int answerTo(unsigned long request, UMockdevIoctlData* data);
  [[nodiscard]] int answerToStreaming(unsigned long request, UMockdevIoctlData* data);
  [[nodiscard]] int answerToBuffers(unsigned long request, UMockdevIoctlData* data);
  [[nodiscard]] bool isPackets(std::uint32_t type) const;
  void fillFormat(v4l2_format& format) const;
  [[nodiscard]] int setFormat(v4l2_format& format);
  [[nodiscard]] int makeBuffers(v4l2_requestbuffers& request);
  [[nodiscard]] int start(bool packets);
  [[nodiscard]] int stop(bool packets);
  void work();
  [[nodiscard]] bool deliver();
  [[nodiscard]] bool decodeOne();
  void finishDrain();
  void announce(const Size& size);
  void giveLast();
  void fill(std::uint32_t index);
  [[nodiscard]] Size padded(const Size& size) const;
  [[nodiscard]] std::uint32_t stride() const { return padded(size_).width + kind_.row_padding; }
  [[nodiscard]] std::uint32_t lumaBytes() const { return stride() * padded(size_).height; }

  UMockdevTestbed* bed_;
  std::string name_, node_, device_;
  const CodecKind kind_;

  std::mutex lock_;  // guards all members below
  std::unique_ptr<CodecLibrary> library_;
  std::uint8_t* memory_ = nullptr;
  std::uint32_t next_offset_ = 0;
  std::uint32_t packet_bytes_ = 0;
  Size size_;  // the last one reported
  std::vector<std::uint32_t> packet_offsets_, picture_offsets_;
  std::deque<Packet> packets_;
  std::deque<std::uint32_t> empty_;
  std::deque<Done> packets_done_, pictures_done_;
  int events_ = 0;
  bool packets_run_ = false, pictures_run_ = false;
  bool draining_ = false, drained_ = false, last_given_ = false;
  bool changing_ = false;
  bool plugged_ = true, hung_ = false;
  int hang_after_ = 0, hangs_left_ = 0, unplug_after_ = 0;
  int given_ = 0;  // since it was opened
  int openings_ = 0, pictures_ = 0, drains_ = 0, unknown_ = 0;
  RequestLoop requests_;
};

}  // namespace relievo::test

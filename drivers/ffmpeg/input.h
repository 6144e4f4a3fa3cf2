// SPDX-License-Identifier: Apache-2.0
// Opens an address as a container of FFmpeg's, once: what it may open is bounded, and every wait is interruptible.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "drivers/ffmpeg/address.h"
#include "drivers/ffmpeg/file_times.h"
#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/watch.h"
#include "platform/error.h"
#include "platform/unique_fd.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace relievo::ffmpeg {

class Input;

struct FormatCloser {
  std::shared_ptr<Input> input;             // of the container, which outlives it
  mutable std::unique_ptr<BlockUser> user;  // once it is open
  void operator()(AVFormatContext* context) const noexcept;
};
using FormatPtr = std::unique_ptr<AVFormatContext, FormatCloser>;

class Input {
 public:
  struct Opened {
    FormatPtr container;  // its streams have been found
    Address address;
    MonotonicTime arrival;
  };
  // `parts_from`: lists are read without the parts before that time of theirs (later_parts.h).
  [[nodiscard]] Result<Opened> open(const std::string& url, Duration parts_from = Duration(0));
  // Of `open` and of all that reads the container.
  [[nodiscard]] Watch& watch() noexcept { return watch_; }
  // Call before each read. Resets the number of files and addresses that the container may still open.
  void beginReading() noexcept { opens_ = 0; }
  // Call for a seek: what was lost before it leaves no gap behind it.
  void beginElsewhere() noexcept {
    losses_ = 0;
    any_part_ = false;
    in_gap_ = false;
    missing_.clear();
  }
  // As av_read_frame, of the container that was opened here.
  int readFrame(AVFormatContext& container, AVPacket& packet);
  // Whether something is missing near a packet that was read here, as far as FFmpeg has told it.
  [[nodiscard]] Doubt doubtOf(const AVPacket& packet, const AVStream& stream) const noexcept;
  // How often parts could not be opened, since the film was opened or sought. It was logged. Neighbours count as one,
  // since they leave one gap. Those before the first part that could be opened leave none.
  [[nodiscard]] unsigned losses() const noexcept { return losses_; }
  // Whether FFmpeg has warned at the last read.
  [[nodiscard]] bool isDoubtful() const noexcept { return doubtful_; }
  [[nodiscard]] bool isPipe() const noexcept { return pipe_.valid(); }
  void closePipe() noexcept { pipe_.reset(); }

 private:
  [[nodiscard]] Result<void> openPipe(Address& address);
  [[nodiscard]] Result<void> openFile(const Address& address, AVIOContext*& file);
  static int openCounted(AVFormatContext* context, AVIOContext** file, const char* url, int flags,
                         AVDictionary** options);
  int openAny(AVFormatContext* context, AVIOContext** file, const char* url, int flags, AVDictionary** options);
  void noteLost();
  void tellLost(const std::string& part) const;
  [[nodiscard]] bool isUnsure(std::int64_t place) const noexcept;
  [[nodiscard]] int shorten(AVFormatContext* context, AVIOContext*& list);
  void readLanguages(AVFormatContext& list);
  static int closeAny(AVFormatContext* context, AVIOContext* file);

  Watch watch_;
  decltype(AVFormatContext::io_open) open_file_ = nullptr;  // FFmpeg's own
  decltype(AVFormatContext::io_close2) close_file_ = nullptr;
  std::string url_;
  Duration parts_from_{0};
  AVIOContext* first_list_ = nullptr;  // the container's own, if it was shortened
  bool reads_files_ = false;
  int opens_ = 0;
  bool opened_ = false;
  std::map<std::string, std::string> of_lists_;  // options for what lists name
  std::string first_part_;                       // of a list
  std::string missing_;                          // the part that could not be opened just now
  std::string first_lost_;
  bool in_gap_ = false;  // until a part can be opened
  unsigned lost_ = 0;    // parts that could not be opened
  unsigned losses_ = 0;
  bool is_list_ = false;   // it has named other files or addresses
  bool any_part_ = false;  // could be opened, since then
  bool doubtful_ = false;
  std::int64_t doubtful_until_ = 0;  // the byte to which the container was read while it was opened, if it warned
  UniqueFd pipe_;                    // outlives the container that reads from it
};

}  // namespace relievo::ffmpeg

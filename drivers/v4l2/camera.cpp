// SPDX-License-Identifier: Apache-2.0
// Negotiates format and rate with the camera's driver, and takes filled buffers.
#include "drivers/v4l2/camera.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <vector>

#include "drivers/v4l2/control.h"
#include "hal/back_end_name.h"

namespace relievo::v4l2 {
namespace {

constexpr Duration kPatience = std::chrono::seconds(3);
constexpr Duration kNap = std::chrono::milliseconds(1);  // after poll(2) announced a picture and there was none
constexpr std::uint32_t kBuffers = 16;                   // those that a player holds, and those being filled
constexpr std::uint32_t kLeftToCamera = 4;
constexpr double kFastest = 1e4;  // frames a second
constexpr int kFailedTakes = 64;  // failures in a row, until the camera counts as gone

constexpr const char* kForm =
    "write a camera as v4l2:DEVICE[,FORMAT][,WIDTHxHEIGHT][@FPS], such as v4l2:/dev/video0,Z16,640x480@30";
constexpr const char* kUnknownFormat =
    "it has none of the supported formats: Z16 Y16 Y12 Y10 YUYV UYVY NV12 RGB3 BGR3 GREY MJPG JPEG H264";
constexpr const char* kGone = "the camera has gone away; check its cable";

template <class T>
bool readNumber(std::string_view text, T& value) noexcept {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value > 0;
}

// "640x480"
bool readSize(std::string_view text, Wish& wish) noexcept {
  const std::size_t by = text.find('x');
  return by != text.npos && readNumber(text.substr(0, by), wish.width) && readNumber(text.substr(by + 1), wish.height);
}

Error openError(int code) noexcept {
  switch (code) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return {ErrorCode::NotFound, code, "there is no such camera; ls /dev/video* lists the cameras"};
    case EACCES:
    case EPERM:
      return {ErrorCode::PermissionDenied, code, "no permission to open it; add this user to the group video"};
    default:
      return {ErrorCode::Io, code, "it cannot be opened; is another program using it?"};
  }
}

}  // namespace

Result<Wish> parseAddress(const std::string& url) {
  const auto refuse = [] { return fail(ErrorCode::InvalidArgument, kForm); };
  const BackEndName name(url);
  if (!name.withArgument("v4l2")) return refuse();
  std::string_view words = *name.argument;
  Wish wish;
  if (const std::size_t at = words.rfind('@'); at != words.npos) {
    if (!readNumber(words.substr(at + 1), wish.frames_per_s) || wish.frames_per_s > kFastest) return refuse();
    words = words.substr(0, at);
  }
  wish.device = words.substr(0, words.find(','));
  if (wish.device.empty()) return refuse();
  while (words.find(',') != words.npos) {
    words.remove_prefix(words.find(',') + 1);
    const std::string_view word = words.substr(0, words.find(','));
    if (readSize(word, wish)) continue;
    wish.fourcc = fourccOf(word);
    if (!wish.fourcc || findFormat(*wish.fourcc) == nullptr) return refuse();
  }
  return wish;
}

Camera::Camera() : wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

Result<void> Camera::open(const Wish& wish) {
  UniqueFd device(::open(wish.device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (!device.valid()) return std::unexpected(openError(errno));
  if (auto known = identify(device.get()); !known) return known;
  if (auto chosen = choose(device.get(), wish); !chosen) return chosen;
  setRate(device.get(), wish.frames_per_s);
  auto memory = CameraMemory::make(std::move(device), kBuffers);
  if (!memory) return std::unexpected(memory.error());
  memory_ = std::move(*memory);
  last_count_.reset();
  last_taken_.reset();
  lost_ = 0;
  return {};
}

void Camera::close() noexcept {
  if (memory_) memory_->close();
  memory_.reset();
}

Result<void> Camera::identify(int device) {
  v4l2_capability is{};
  if (control(device, VIDIOC_QUERYCAP, &is) < 0) {
    return fail(errno == ENODEV ? ErrorCode::NotFound : ErrorCode::Unsupported,
                "it is not a V4L2 device; cameras are /dev/video0, /dev/video1, ..", errno);
  }
  const std::uint32_t can = (is.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? is.device_caps : is.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0) {
    return fail(ErrorCode::Unsupported,
                "it does not stream single-plane pictures; a camera has several nodes, try another /dev/video*");
  }
  const auto* const card = reinterpret_cast<const char*>(is.card);
  card_.assign(card, ::strnlen(card, sizeof is.card));
  return {};
}

Result<void> Camera::choose(int device, const Wish& wish) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (control(device, VIDIOC_G_FMT, &format) < 0)
    return fail(ErrorCode::Io, "its driver does not report its format; plug the camera in again", errno);
  v4l2_pix_format& picture = format.fmt.pix;
  const bool known = findFormat(picture.pixelformat) != nullptr;
  const auto fourcc = wish.fourcc ? wish.fourcc : bestFormat(device);
  if (!fourcc && !known) return fail(ErrorCode::Unsupported, kUnknownFormat);
  if (fourcc) picture.pixelformat = *fourcc;
  if (wish.width > 0) {
    picture.width = wish.width;
    picture.height = wish.height;
  }
  picture.bytesperline = picture.sizeimage = 0;
  picture.field = V4L2_FIELD_ANY;
  const std::uint32_t wanted = picture.pixelformat;
  if (control(device, VIDIOC_S_FMT, &format) < 0) {
    return fail(errno == EBUSY ? ErrorCode::Io : ErrorCode::Unsupported,
                "it rejects this format; another program may be using it", errno);
  }
  if (picture.pixelformat != wanted) {
    return fail(ErrorCode::Unsupported, "it has no such format; v4l2-ctl --list-formats-ext lists them");
  }
  if (wish.width > 0 && (picture.width != wish.width || picture.height != wish.height)) {
    return fail(ErrorCode::Unsupported, "it has no such size; v4l2-ctl --list-formats-ext lists them");
  }
  format_ = findFormat(picture.pixelformat);
  const auto layout = layoutOf(*format_, picture);
  if (!layout) return fail(ErrorCode::Corrupt, "its driver reports an impossible picture size; try another format");
  layout_ = *layout;
  return {};
}

// Z16 if the camera has it; else nullopt, to keep the current format, if that is supported; else the first supported
// one.
std::optional<std::uint32_t> Camera::bestFormat(int device) const {
  std::optional<std::uint32_t> first;
  v4l2_format now{};
  now.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (control(device, VIDIOC_G_FMT, &now) == 0 && findFormat(now.fmt.pix.pixelformat) != nullptr) {
    first = now.fmt.pix.pixelformat;
  }
  v4l2_fmtdesc each{};
  each.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  for (; control(device, VIDIOC_ENUM_FMT, &each) == 0; ++each.index) {
    if (each.pixelformat == V4L2_PIX_FMT_Z16) return each.pixelformat;
    if (!first && findFormat(each.pixelformat) != nullptr) first = each.pixelformat;
  }
  return first;
}

// The driver chooses the nearest rate that the camera has; the pictures' times show the actual one.
void Camera::setRate(int device, double frames_per_s) {
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_fract& period = rate.parm.capture.timeperframe;
  if (frames_per_s > 0) {
    period = {1000, static_cast<std::uint32_t>(std::lround(1000 * frames_per_s))};
    control(device, VIDIOC_S_PARM, &rate);
  }
  rate.parm.capture = {};
  const bool told = control(device, VIDIOC_G_PARM, &rate) == 0 && period.numerator > 0 && period.denominator > 0;
  period_ = told ? fromSeconds(static_cast<double>(period.numerator) / period.denominator) : Duration(0);
}

void Camera::interrupt() noexcept {
  interrupted_ = true;
  constexpr std::uint64_t kOne = 1;
  static_cast<void>(::write(wake_.get(), &kOne, sizeof kOne));  // fails only if full: it is awake already
}

void Camera::forgive() noexcept {
  interrupted_ = false;
  std::uint64_t count = 0;
  static_cast<void>(::read(wake_.get(), &count, sizeof count));  // fails only if empty already
}

Result<Picture> Camera::take() {
  const MonotonicTime deadline = clock_.now() + kPatience;
  int failed = 0;
  for (;;) {
    const auto there = waitUntil(deadline);
    if (!there) return std::unexpected(there.error());
    if (!*there)
      return fail(ErrorCode::Timeout,
                  "the camera has sent no picture for three seconds; unplug it and plug it in again");
    Picture picture;
    const auto taken = takeBuffer(picture);
    if (taken && *taken) return picture;
    if (taken) continue;
    if (taken.error().os_error == EAGAIN) {
      clock_.sleepUntil(clock_.now() + kNap);
    } else if (taken.error().os_error != EIO || ++failed >= kFailedTakes) {
      return std::unexpected(taken.error());
    } else {
      ++lost_;
    }
  }
}

// False after the deadline.
Result<bool> Camera::waitUntil(MonotonicTime deadline) {
  std::array<pollfd, 2> wait{{{memory_->device(), POLLIN, 0}, {wake_.get(), POLLIN, 0}}};
  int ready = 0;
  do {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - clock_.now());
    if (interrupted_) return fail(ErrorCode::Cancelled, "interrupted while waiting for the camera");
    if (left.count() <= 0) return false;
    ready = ::poll(wait.data(), wait.size(), static_cast<int>(left.count()));
  } while (ready < 0 && errno == EINTR);
  if (ready < 0) return fail(ErrorCode::Lost, kGone, errno);
  if (wait[1].revents != 0) return fail(ErrorCode::Cancelled, "interrupted while waiting for the camera");
  return ready > 0;
}

// False for a damaged or out-of-order picture, which is counted as lost. Gaps in the camera's sequence numbers are
// counted as well; some drivers do not number pictures and always send the same number.
Result<bool> Camera::takeBuffer(Picture& picture) {
  v4l2_buffer filled{};
  if (const int error = memory_->take(filled); error != 0) return fail(ErrorCode::Lost, kGone, error);
  const std::uint32_t step = last_count_ ? filled.sequence - *last_count_ : 1;
  constexpr std::uint32_t kBackward = 1U << 31;
  if (step > 1 && step < kBackward) lost_ += step - 1;
  last_count_ = filled.sequence;

  const bool monotonic = (filled.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  picture.taken = monotonic ? MonotonicTime(std::chrono::seconds(filled.timestamp.tv_sec) +
                                            std::chrono::microseconds(filled.timestamp.tv_usec))
                            : clock_.now();
  const std::size_t bytes = filled.bytesused > 0 ? filled.bytesused : layout_.bytes;
  const bool whole = (filled.flags & V4L2_BUF_FLAG_ERROR) == 0 && bytes >= layout_.bytes &&
                     bytes <= memory_->bytes(filled.index) && bytes > 0;
  if (!whole || (last_taken_ && picture.taken <= *last_taken_)) {
    memory_->give(filled.index);
    ++lost_;
    return false;
  }
  last_taken_ = picture.taken;
  const MonotonicTime taken = picture.taken;
  picture = pictureOf(filled.index, bytes);
  picture.taken = taken;
  return true;
}

Picture Camera::pictureOf(std::uint32_t index, std::size_t bytes) {
  if (format_->raw && memory_->withCamera() >= std::min(kLeftToCamera, memory_->count() - 1)) {
    const Held* const held = new Held(memory_, index);
    return {std::shared_ptr<const Held>(held, HeldDeleter{}), held->data, bytes, {}};
  }
  const std::uint8_t* const data = memory_->data(index);
  auto copy = std::make_shared<std::vector<std::uint8_t>>(data, data + bytes);
  memory_->give(index);
  return {copy, copy->data(), bytes, {}};
}

}  // namespace relievo::v4l2

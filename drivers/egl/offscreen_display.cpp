// SPDX-License-Identifier: Apache-2.0
// The display without a screen: a framebuffer object, read back after each frame if it is captured.
#include <EGL/egl.h>
#include <GLES3/gl3.h>

#include <array>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/egl/egl.h"
#include "drivers/egl/egl_context.h"
#include "drivers/egl/offscreen_platform.h"
#include "drivers/egl/y4m_writer.h"

namespace relievo {
namespace {

// On the first display that can draw; else the error is the first one's.
Result<EglContext> createContext() {
  std::optional<Error> first;
  for (EGLDisplay display : offscreenDisplays()) {
    auto context = EglContext::createForPbuffers(display);
    if (context) return context;
    if (!first) first = context.error();
  }
  if (first) return std::unexpected(*first);
  return EglContext::createForPbuffers(EGL_NO_DISPLAY);  // says what to install
}

class OffscreenDisplay final : public Display {
 public:
  OffscreenDisplay(Capture capture, const Clock& clock) : capture_(std::move(capture)), clock_(clock) {}
  ~OffscreenDisplay() override { close(); }

  [[nodiscard]] DisplayCapabilities capabilities() const noexcept override {
    return {.name = "offscreen", .gles = true, .refresh_period = Duration(0)};
  }

 private:
  Result<void> openDisplay(const DisplayConfig& config) override;
  Result<DisplaySurface> startFrame() override;
  Result<Duration> showFrame() override;
  void closeDisplay() noexcept override;
  Result<void> createFramebuffer();
  Result<void> makeCurrent() noexcept;

  Capture capture_;
  const Clock& clock_;
  std::optional<EglContext> context_;
  EGLSurface pbuffer_ = EGL_NO_SURFACE;  // not every EGL lets a context be current without a surface
  DisplaySurface surface_;
  std::optional<Y4mWriter> writer_;
  std::vector<std::uint8_t> readback_;
};

Result<void> OffscreenDisplay::openDisplay(const DisplayConfig& config) {
  auto context = createContext();
  if (!context) return std::unexpected(context.error());
  context_.emplace(std::move(*context));

  constexpr std::array<EGLint, 5> kOnePixel{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
  pbuffer_ = eglCreatePbufferSurface(context_->display(), context_->config(), kOnePixel.data());
  if (pbuffer_ == EGL_NO_SURFACE) return fail(ErrorCode::Exhausted, "EGL cannot create a pbuffer; free some memory");
  if (auto current = makeCurrent(); !current) return current;

  surface_ = {.framebuffer = 0, .width = config.width, .height = config.height};
  if (auto made = createFramebuffer(); !made) return made;
  if (capture_.path.empty()) return {};

  auto writer = Y4mWriter::create(capture_.path, config.width, config.height, capture_.rate);
  if (!writer) return std::unexpected(writer.error());
  writer_.emplace(std::move(*writer));
  readback_.resize(static_cast<std::size_t>(config.width) * config.height * 4);
  return {};
}

Result<void> OffscreenDisplay::makeCurrent() noexcept {
  if (!context_) return fail(ErrorCode::InvalidState, "the display is not open");
  return context_->makeCurrent(pbuffer_);
}

// The GL names are deleted with the context.
Result<void> OffscreenDisplay::createFramebuffer() {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (surface_.width > largest || surface_.height > largest) {
    return fail(ErrorCode::InvalidArgument,
                "the picture is larger than the GL driver can draw; choose a smaller --size");
  }
  std::array<GLuint, 2> buffers{};
  glGenRenderbuffers(2, buffers.data());
  glGenFramebuffers(1, &surface_.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, surface_.framebuffer);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, surface_.width, surface_.height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, surface_.width, surface_.height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
  const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (glGetError() == GL_OUT_OF_MEMORY || !complete) {
    return fail(ErrorCode::Exhausted, "no memory for a picture of this size; choose a smaller --size");
  }
  return {};
}

Result<DisplaySurface> OffscreenDisplay::startFrame() {
  if (auto current = makeCurrent(); !current) return std::unexpected(current.error());
  glBindFramebuffer(GL_FRAMEBUFFER, surface_.framebuffer);
  return surface_;
}

Result<Duration> OffscreenDisplay::showFrame() {
  const MonotonicTime shown = clock_.now();
  if (auto current = makeCurrent(); !current) return std::unexpected(current.error());
  if (!writer_) {
    glFlush();
    return Duration(0);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, surface_.framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, surface_.width, surface_.height, GL_RGBA, GL_UNSIGNED_BYTE, readback_.data());
  if (glGetError() != GL_NO_ERROR) return fail(ErrorCode::Io, "the picture cannot be read back from GL");
  if (auto written = writer_->write(readback_, shown); !written) return std::unexpected(written.error());
  return Duration(0);
}

void OffscreenDisplay::closeDisplay() noexcept {
  writer_.reset();
  readback_ = {};
  if (!context_) return;
  // EGL defers the destruction until the context that is current on it is destroyed.
  if (pbuffer_ != EGL_NO_SURFACE) eglDestroySurface(context_->display(), std::exchange(pbuffer_, EGL_NO_SURFACE));
  context_.reset();
  surface_ = {};
}

}  // namespace

Capture Capture::parse(std::string word) {
  const std::size_t at = word.rfind('@');
  if (at == std::string::npos) return {std::move(word)};
  double rate = 0;
  const char* const end = word.data() + word.size();
  const auto [rest, problem] = std::from_chars(word.data() + at + 1, end, rate);
  const bool is_rate = problem == std::errc() && rest == end && rate >= 0.001 && rate <= 1000.0;
  if (!is_rate) return {std::move(word)};
  return {word.substr(0, at), rate};
}

std::unique_ptr<Display> makeOffscreenDisplay(Capture capture, const Clock& clock) {
  return std::make_unique<OffscreenDisplay>(std::move(capture), clock);
}

}  // namespace relievo

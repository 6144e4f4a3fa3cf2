// SPDX-License-Identifier: Apache-2.0
// Any text as a configuration: it is rejected in one line that names the position, or its printed form reads back as
// the same.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "app/player/setup/config_file.h"
#include "app/player/setup/options.h"
#include "platform/unique_fd.h"
#include "tests/fuzz/fuzz_port.h"

namespace relievo {
namespace {

using test::require;

// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& text) : fd_(::memfd_create("relievo.toml", MFD_CLOEXEC)) {
    require(::write(fd_.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()), "memory for a file");
  }
  [[nodiscard]] int fd() const { return fd_.get(); }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_.get()); }
  [[nodiscard]] std::string text() const {
    std::string text(static_cast<std::size_t>(::lseek(fd_.get(), 0, SEEK_END)), '\0');
    require(::pread(fd_.get(), text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()), "it is read back");
    return text;
  }

 private:
  UniqueFd fd_;
};

// While it exists, output to `stream` goes into `file`.
class Redirected {
 public:
  Redirected(int stream, int file) : stream_(stream), kept_(::dup(stream)) { ::dup2(file, stream_); }
  ~Redirected() {
    std::fflush(stdout);
    ::dup2(kept_.get(), stream_);
  }
  Redirected(const Redirected&) = delete;
  Redirected& operator=(const Redirected&) = delete;

 private:
  int stream_;
  UniqueFd kept_;
};

// The output of --print-config; empty if the text is rejected.
std::string printed(const std::string& text) {
  const MemoryFile file(text), out(""), err("");
  const std::string path = file.path();
  const std::array words{"relievo", "play", "--print-config", "--config", path.c_str()};
  int exit_code = -1;
  {
    const Redirected to_out(STDOUT_FILENO, out.fd()), to_err(STDERR_FILENO, err.fd());
    const auto options =
        parseOptions(static_cast<int>(words.size()), words.data(),
                     {"kms[:CARD] window offscreen[:FILE] mock", "falcon sim[:HAND] pointer replay:FILE mock none",
                      "evdev keys window script:FILE none", "alsa[:DEVICE] null none"});
    require(!options, "it printed, or it refused");
    exit_code = options.error();
  }
  if (exit_code == 0) return out.text();
  const std::string refusal = err.text();
  require(refusal.starts_with("relievo: " + path) && refusal.find('\n') == refusal.size() - 1, "one line, of the file");
  return "";
}

std::string entriesOf(const std::string& text) {
  const auto config = parseConfig(text, "printed");
  require(config.has_value(), "what is printed reads back");
  std::string entries;
  for (const ConfigEntry& entry : config->entries) {
    entries += entry.table + "." + entry.key + '\0';
    for (const std::string& word : entry.words) entries += word + '\0';
  }
  return entries;
}

void fuzz(const std::string& text) {
  const std::string first = printed(text);
  if (first.empty()) return;
  const std::string second = printed(first);
  require(entriesOf(first) == entriesOf(second), "as the same");
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::fuzz(std::string(reinterpret_cast<const char*>(bytes), size));
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "app/media/playlist.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <utility>

#include "platform/files/answered_place.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::array<std::string_view, 8> kNetwork{"http", "https", "rtsp", "rtsps", "rtp", "udp", "srt", "tcp"};

// "http" for "http://..", "concat" for "concat:a|b"; empty for a path. A single letter is not a scheme.
std::string schemeOf(std::string_view url) {
  const std::size_t colon = url.find(':');
  if (colon == std::string_view::npos || colon < 2) return {};
  const std::string_view scheme = url.substr(0, colon);
  const bool is_one = std::ranges::all_of(scheme, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
  });
  return is_one ? lowerCase(scheme) : std::string{};
}

bool isOnNetwork(std::string_view url) {
  return std::ranges::find(kNetwork, schemeOf(url)) != kNetwork.end();
}

std::string nameOf(std::string_view url) {
  return lowerCase(withoutQuery(url));
}

// Resolves a path relative to a URL: "//host/a" keeps the scheme, "/a" the host, "a" the folder. The ? and # parts of
// the playlist's address do not count as folders.
std::string besideUrl(std::string_view path, std::string_view from) {
  from = from.substr(0, from.find_first_of("?#"));
  const std::size_t host = from.find("://") + 3;
  if (path.starts_with("//")) return std::string(from.substr(0, host - 2)) + std::string(path);
  const std::size_t root = std::min(from.find('/', host), from.size());
  if (path.starts_with('/')) return std::string(from.substr(0, root)) + std::string(path);
  const std::size_t last = from.rfind('/');
  const std::string_view folder =
      last == std::string_view::npos || last < root ? from.substr(0, root) : from.substr(0, last);
  return std::string(folder) + "/" + std::string(path);
}

class Parser {
 public:
  explicit Parser(const std::string& from) : from_(from), from_network_(isOnNetwork(from)) {}

  Outcome<void> addLine(std::string_view line) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.remove_suffix(1);
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.front())) != 0) line.remove_prefix(1);
    if (line.empty()) return {};
    constexpr std::string_view kInfo = "#EXTINF:", kDepth = "#RELIEVO-DEPTH:";
    if (line.starts_with(kInfo)) {
      const std::size_t comma = line.find(',');
      next_.title = comma == std::string_view::npos ? "" : std::string(line.substr(comma + 1));
      return {};
    }
    if (line.starts_with(kDepth)) {
      next_.depth_url = address(line.substr(kDepth.size()));
      return {};
    }
    if (line.front() == '#') return {};
    next_.url = address(line);
    if (entries_.size() == kMostEntries) {
      return failOn(from_, {ErrorCode::Corrupt, 0, "the playlist has more than 10000 entries; split it"});
    }
    entries_.push_back(std::exchange(next_, {}));
    return {};
  }

  Outcome<std::vector<PlaylistEntry>> entries() && {
    if (entries_.empty())
      return failOn(from_,
                    {ErrorCode::Corrupt, 0, "the playlist names no film; write one path or address on each line"});
    return std::move(entries_);
  }

 private:
  // Resolves the address and marks the entry if it may not be opened.
  std::string address(std::string_view text) {
    const std::string scheme = schemeOf(text);
    if (from_network_ && scheme.empty()) return besideUrl(text, from_);
    const bool is_file = scheme == "file" && !from_network_;
    if (is_file) return pathOfFileUrl(text);
    if (isOnNetwork(text)) return std::string(text);
    const std::filesystem::path path{std::string(text)};
    // Puts "./" before a bare file name: FFmpeg reads some names as protocols, such as "subfile,,..".
    const auto folder = std::filesystem::path(from_).parent_path();
    std::string beside = path.is_absolute() ? path.string() : ((folder.empty() ? "." : folder) / path).string();
    if (scheme.empty() || (!from_network_ && isThere(beside))) return beside;  // "Alien: Covenant.mkv"
    next_.refused = true;
    return std::string(text);
  }

  const std::string& from_;
  bool from_network_;
  PlaylistEntry next_;
  std::vector<PlaylistEntry> entries_;
};

}  // namespace

std::string_view withoutQuery(std::string_view url) {
  return url.substr(0, isOnNetwork(url) ? url.find_first_of("?#") : url.size());
}

std::string pathOfFileUrl(std::string_view url) {
  url.remove_prefix(std::string_view("file:").size());
  if (url.starts_with("//")) url.remove_prefix(std::min(url.find('/', 2), url.size()));
  std::string path;
  for (std::size_t i = 0; i < url.size(); ++i) {
    unsigned char code = 0;
    const char* const begin = url.data() + i + 1;
    const bool coded =
        url[i] == '%' && url.size() - i > 2 && std::from_chars(begin, begin + 2, code, 16).ptr == begin + 2;
    path += coded ? static_cast<char>(code) : url[i];
    if (coded) i += 2;
  }
  return path;
}

std::string sourceNamed(const std::string& words) {
  if (words.starts_with("file:///")) return pathOfFileUrl(words);
  if (!words.starts_with("file:") || words.starts_with("file://")) return words;
  const std::string plain = words.substr(5), decoded = pathOfFileUrl(words);  // Java writes file:/two%20words.mkv
  return !isThere(plain) && isThere(decoded) ? decoded : plain;               // and "%04d" names numbered pictures
}

bool mayBePlaylist(std::string_view url) {
  const std::string name = nameOf(url);
  return name.ends_with(".m3u") || name.ends_with(".m3u8");
}

bool isPlaylist(std::string_view url, std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.find("#EXT-X-") != std::string_view::npos) return false;
  return text.starts_with("#EXTM3U") || nameOf(url).ends_with(".m3u");
}

Outcome<std::vector<PlaylistEntry>> parsePlaylist(std::string_view text, const std::string& from) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  Parser parser(from);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (auto added = parser.addLine(text.substr(0, end)); !added) return std::unexpected(added.error());
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::move(parser).entries();
}

}  // namespace relievo

// SPDX-License-Identifier: Apache-2.0
// One thread accepts connections, and one per connection answers.
#include "tests/support/network/http_server.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "tests/support/network/loopback.h"

namespace relievo::test {
namespace {

constexpr Duration kSlice = std::chrono::milliseconds(20);

std::optional<std::string> contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace

HttpServer::HttpServer(std::string folder) : folder_(std::move(folder)), listener_(bindLoopback(SOCK_STREAM)) {
  port_ = portOf(listener_);
  thread_ = std::thread([this] { serve(); });
}

HttpServer::~HttpServer() {
  ending_ = true;
  thread_.join();
  for (std::thread& each : answers_) each.join();
}

std::string HttpServer::url(const std::string& file) const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/" + file;
}

std::vector<std::string> HttpServer::requests() const {
  const std::scoped_lock lock(mutex_);
  return requests_;
}

void HttpServer::serve() {
  while (!ending_) {
    if (!readable(listener_, kSlice)) continue;
    UniqueFd connection(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (const Duration away = away_.exchange(Duration(0)); away > Duration(0)) {
      away_until_ = clock_.now() + away;
      fault_over_ = away_until_;
    }
    if (clock_.now() < away_until_) continue;  // closed at once
    answers_.emplace_back([this, to = std::move(connection)]() mutable { answer(std::move(to)); });
  }
}

void HttpServer::answer(UniqueFd to) {
  if (!readable(to, std::chrono::seconds(5))) return;
  const std::string head = receiveHead(to);
  const std::size_t slash = head.find('/'), end = head.find(' ', slash);
  if (slash == head.npos || end == head.npos) return;
  const std::string file = head.substr(slash + 1, end - slash - 1);
  const auto content = contentOf(folder_ + "/" + file);
  const std::size_t range = head.find("Range: bytes=");
  const std::size_t from = range == head.npos || !ranges ? 0 : std::stoul(head.substr(range + 13));
  const char* status = !content || from > content->size() ? "404" : from > 0 ? "206" : "200";
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = busy.find(file); found != busy.end() && found->second-- > 0) status = "503";
    requests_.push_back("GET /" + file + " " + status);
  }
  const bool is_list = file.ends_with(".m3u8");
  if (const auto to_file = moved.find(file); to_file != moved.end()) {
    sendAll(to, "HTTP/1.1 302 Found\r\nLocation: /" + to_file->second +
                    "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    return;
  }
  if (!is_list && !cookie.empty() && head.find("Cookie: " + cookie) == head.npos) status = "403";
  if (*status != '2') {
    sendAll(to, std::string("HTTP/1.1 ") + status + " No\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    return;
  }
  std::string answer_head = std::string("HTTP/1.1 ") + status + " OK\r\nConnection: close\r\n";
  if (is_list && !cookie.empty()) answer_head += "Set-Cookie: " + cookie + "; path=/\r\n";
  if (ranges) answer_head += "Accept-Ranges: bytes\r\n";
  answer_head += "Content-Length: " + std::to_string(content->size() - from) + "\r\n";
  if (from > 0) {
    answer_head += "Content-Range: bytes " + std::to_string(from) + "-" + std::to_string(content->size() - 1) + "/" +
                   std::to_string(content->size()) + "\r\n";
  }
  if (sendAll(to, answer_head + "\r\n")) static_cast<void>(sendBody(to, file, *content, from));
}

bool HttpServer::sendBody(const UniqueFd& to, const std::string& file, const std::string& body, std::size_t from) {
  const std::size_t slice =
      bytes_per_s > 0 ? static_cast<std::size_t>(bytes_per_s * toSeconds(kSlice)) + 1 : body.size();
  MonotonicTime next = clock_.now();
  for (std::size_t at = from; at < body.size() && !ending_;) {
    Fault fault;
    {
      const std::scoped_lock lock(mutex_);
      const auto found = faults.find(file);
      if (found != faults.end() && at >= found->second.after_bytes) fault = faults.extract(found).mapped();
    }
    if (fault.away > Duration(0)) {
      away_ = fault.away;
      return false;
    }
    if (fault.stall > Duration(0)) {
      fault_over_ = next = clock_.now() + fault.stall;
      while (clock_.now() < next && !ending_) clock_.sleepUntil(std::min(next, clock_.now() + kSlice));
    }
    if (!sendAll(to, std::string_view(body).substr(at, slice))) return false;
    at += std::min(slice, body.size() - at);
    if (bytes_per_s > 0) clock_.sleepUntil(next += kSlice);
  }
  return true;
}

}  // namespace relievo::test

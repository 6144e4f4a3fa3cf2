// SPDX-License-Identifier: Apache-2.0
// The messages are those of docs.haply.co, "Simulation channel", versions 3.4 and 3.5.
#include "tests/support/device/inverse3_service.h"

extern "C" {
#include <libavutil/base64.h>
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "platform/allocation_counter.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

std::string acceptKey(const std::string& key) {
  const std::string text = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  AVSHA* const sha = av_sha_alloc();
  std::uint8_t sum[20];
  av_sha_init(sha, 160);
  av_sha_update(sha, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  av_sha_final(sha, sum);
  av_free(sha);
  char encoded[AV_BASE64_SIZE(sizeof sum)];
  return av_base64_encode(encoded, sizeof encoded, sum, sizeof sum);
}

std::string vectorText(const glm::dvec3& v) {
  char text[120];
  std::snprintf(text, sizeof text, R"({"x":%.9g,"y":%.9g,"z":%.9g})", v.x, v.y, v.z);
  return text;
}

const char* word(bool yes) {
  return yes ? "true" : "false";
}

// The value of a name, without a copy; an empty object if it is not there.
const json& valueOf(const json& object, const char* name) {
  static const json none = json::object();
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

}  // namespace

std::string serverFrame(unsigned kind, std::string_view payload, bool final) {
  std::string frame{static_cast<char>((final ? 128 : 0) + kind)};
  if (payload.size() < 126) {
    frame += static_cast<char>(payload.size());
  } else if (payload.size() < 65536) {
    frame += static_cast<char>(126);
    frame += static_cast<char>(payload.size() / 256);
    frame += static_cast<char>(payload.size() % 256);
  } else {
    frame += static_cast<char>(127);
    for (int shift = 56; shift >= 0; shift -= 8) frame += static_cast<char>(payload.size() >> shift & 255);
  }
  return frame.append(payload);
}

bool Inverse3Service::chance(double probability) {
  const bool yes = probability > 0 && upTo(1) < probability;
  faults_done_ += yes ? 1 : 0;
  return yes;
}

bool Inverse3Service::connect(MonotonicTime now) {
  running = running || comes_back;
  if (!running || now < dead_until_) return false;
  endConnection();
  connected_ = true;
  hung_up_ = false;
  ++connections_;
  if (began_ == MonotonicTime{}) began_ = now;
  return true;
}

void Inverse3Service::disconnect() {
  endConnection();
}

// The service ends; nobody holds the device any more.
void Inverse3Service::endConnection() {
  connected_ = upgraded_ = centred_ = false;
  incoming_.clear();
  outgoing_.clear();
  force_n_ = glm::dvec3(0);
}

void Inverse3Service::receive(std::string_view bytes, MonotonicTime now) {
  incoming_.append(bytes);
  if (stalled(now) || deaf) return;
  if (!upgraded_) upgrade(now);
  readFrames(now);
}

std::string Inverse3Service::take(MonotonicTime now) {
  if (!running) endConnection();
  if (stalled(now)) return {};
  if (stalled_until_ != MonotonicTime{}) {
    force_since_ = std::max(force_since_, stalled_until_);
    stalled_until_ = MonotonicTime{};
    if (connected_ && !deaf) readFrames(now);
  }
  std::string bytes;
  while (!outgoing_.empty() && outgoing_.front().due <= now) {
    bytes += outgoing_.front().bytes;
    outgoing_.pop_front();
  }
  if (hung_up_ && outgoing_.empty() && bytes.empty()) endConnection();
  return bytes;
}

void Inverse3Service::upgrade(MonotonicTime now) {
  const std::size_t end = incoming_.find("\r\n\r\n");
  if (end == std::string::npos) return;
  const std::string name = "\r\nSec-WebSocket-Key: ";
  const std::size_t key = incoming_.find(name);
  if (!incoming_.starts_with("GET / HTTP/1.1\r\n") || key == std::string::npos) {
    error_ = "no request for a WebSocket: " + incoming_;
    return;
  }
  const std::size_t from = key + name.size();
  const std::string accept = acceptKey(incoming_.substr(from, incoming_.find("\r\n", from) - from));
  incoming_.erase(0, end + 4);
  upgraded_ = true;
  std::string text = stateText(now, true, glm::dvec3(0));
  if (version_ == Version::V3_0) text = R"({"inverse3":{"049D":{"config":{"device_info":{"id":"049D","model":4}}}}})";
  if (version_ == Version::V9) text = R"({"devices":{"049D":{"kind":"inverse3","pose":[0,0,0,0,0,0,1]}}})";
  say("HTTP/1.1 101 Switching Protocols\r\nupgrade: WebSocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " +
          accept + "\r\n\r\n" + serverFrame(1, text),
      now);
}

void Inverse3Service::readFrames(MonotonicTime now) {
  for (Frame frame; connected_ && upgraded_ && !stalled(now) && nextFrame(frame);) {
    if (frame.kind == 1) command(frame.payload, now);
    if (frame.kind == 10) ++pongs_;
    if (frame.kind == 8) hung_up_ = true;
  }
  if (std::exchange(new_force_, false) && on_force) on_force(force_n_, now);
}

// RFC 6455, 5.3: the mask is applied by the octet.
bool Inverse3Service::nextFrame(Frame& frame) {
  const auto at = [this](std::size_t i) { return static_cast<std::uint8_t>(incoming_[i]); };
  if (incoming_.size() < 6) return false;
  std::size_t length = at(1) & 127, head = 2;
  if (length == 126) {
    if (incoming_.size() < 8) return false;
    length = at(2) * 256U + at(3);
    head = 4;
  }
  if ((at(1) & 128) == 0 || (at(0) & 0xF0) != 0x80) error_ = "a frame that is not masked, or not whole";
  if (incoming_.size() < head + 4 + length) return false;
  frame.kind = at(0) & 15U;
  frame.payload.clear();
  for (std::size_t i = 0; i < length; ++i) {
    frame.payload += static_cast<char>(at(head + 4 + i) ^ at(head + i % 4));
  }
  incoming_.erase(0, head + 4 + length);
  return true;
}

void Inverse3Service::command(const std::string& text, MonotonicTime now) {
  ++messages_;
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) {
    error_ = "no JSON: " + text;
    return;
  }
  if (message.contains("session")) profile_ = message["session"]["configure"]["profile"].value("name", "");
  for (const json& arm : valueOf(message, "inverse3")) {
    if (arm.value("device_id", "") != id) error_ = "another device: " + text;
    const std::string preset = valueOf(valueOf(arm, "configure"), "preset").value("preset", "");
    centred_ = centred_ || (version_ == Version::V3_5 && preset == "arm_front_centered");
    const json& force = valueOf(valueOf(arm, "commands"), "set_cursor_force");
    const json& vector = valueOf(force, version_ == Version::V3_5 ? "vector" : "values");
    if (!force.empty() && vector.empty()) error_ = "a force in another version's words: " + text;
    if (!vector.empty()) {
      setForce({vector.at("x").get<double>(), vector.at("z").get<double>(), -vector.at("y").get<double>()}, now);
    }
  }
  answer(now);
}

void Inverse3Service::setForce(const glm::dvec3& force_n, MonotonicTime now) {
  force_n_ = plugged ? force_n : glm::dvec3(0);
  force_since_ = now;
  new_force_ = true;
}

void Inverse3Service::answer(MonotonicTime now) {
  const MonotonicTime due = now + fromSeconds(upTo(toSeconds(faults.most_delay)));
  if (chance(faults.stalls)) stalled_until_ = now + fromSeconds(upTo(0.08));
  if (chance(faults.restarts)) {
    dead_until_ = now + 50ms;
    return endConnection();
  }
  if (chance(faults.drops)) return;
  if (chance(faults.pings)) say(serverFrame(9, "are you there?"), due);
  if (chance(faults.breaks_frames)) return say("\x7f\x7f\x7f\x7f", due);
  if (chance(faults.hangs_up)) {
    hung_up_ = true;
    return say(serverFrame(8, std::string("\x03\xe9", 2)), due);
  }
  if (chance(faults.garbles))
    return say(serverFrame(1, R"({"inverse3":[{"device_id":"049D","state":{"cursor_posi)"), due);
  const bool wrong = chance(faults.misplaces);
  const glm::dvec3 error_mm = wrong ? glm::dvec3(20 + upTo(60), -upTo(90), upTo(50)) : glm::dvec3(0);
  const std::string text = stateText(now, false, error_mm);
  std::string frames = serverFrame(1, text);
  if (chance(faults.fragments)) {
    frames = serverFrame(1, text.substr(0, 100), false) + serverFrame(9, "between") +
             serverFrame(0, text.substr(100, 300), false) + serverFrame(0, text.substr(400));
  }
  if (chance(faults.repeats)) say(frames, due);
  const bool held = chance(faults.holds_back);
  say(frames, held ? due + fromSeconds(upTo(0.004)) : due);
}

// In the order of their times; those of one time in the order in which they were said.
void Inverse3Service::say(std::string frames, MonotonicTime due) {
  if (faults.holds_back == 0 && !outgoing_.empty()) due = std::max(due, outgoing_.back().due);
  const auto later = std::ranges::upper_bound(outgoing_, due, {}, &Sent::due);
  outgoing_.insert(later, Sent{due, std::move(frames)});
}

std::string Inverse3Service::stateText(MonotonicTime now, bool whole, const glm::dvec3& error_mm) {
  std::string text = version_ == Version::V3_5 ? R"({"session_id":7,"inverse3":[)" : R"({"inverse3":[)";
  if (!listed_before.empty()) text += armText(listed_before, now, whole, glm::dvec3(50)) + ",";
  if (plugged) text += armText(id, now, whole, error_mm);
  text += R"(],"verse_grip":[{"device_id":"61548",)";
  if (whole) text += R"("config":{"port":"COM3","type":"verse_grip"},)";
  text +=
      std::string(R"("state":{"button":)") + word(wired_button) +
      R"(,"hall":0,"orientation":{"x":-0.5019531,"y":0.8632202,"z":-0.048095703,"w":-0.022338867}},)"
      R"("status":{"error":0,"ready":true}}],"wireless_verse_grip":[{"device_id":"B1","state":{"battery_level":0.98,)"
      R"("buttons":{"a":)" +
      word(button_a) + R"(,"b":)" + word(button_b) +
      R"(,"c":false},"hall":12,"orientation":{"x":0,"y":0,"z":0,"w":1}},"status":{"connected":true}}]})";
  return text;
}

std::string Inverse3Service::armText(const std::string& name, MonotonicTime now, bool whole,
                                     const glm::dvec3& error_mm) const {
  const glm::dvec3 place_mm = hand(toSeconds(now - began_)) + error_mm;
  // x right, y forward, z up, in metres; from the base unless another origin was asked for.
  glm::dvec3 place_m(place_mm.x / 1000, -place_mm.z / 1000, place_mm.y / 1000);
  if (!centred_) place_m += glm::dvec3(0, -0.15, 0.19);
  const bool modern = version_ == Version::V3_5;
  std::string text = std::string(R"({"device_id":")") + name + "\",";
  if (whole) {
    text += R"("config":{"type":")" + type +
            R"(","device_info":{"minor_version":1,"major_version":7,"id":"049D","model":4,)"
            R"("uuid":"2D35F80DD9005F599B68F49944CB04BA"},"port":"COM13","gravity_compensation":{"enabled":true,)"
            R"("scaling_factor":1},"handedness":"right","torque_scaling":{"enabled":true})";
    if (modern) text += R"(,"preset":"defaults","basis":{"permutation":"XYZ"},"filters":{"force_gate":{"gain":0.3}})";
    text += "},";
  }
  text +=
      R"("state":{"angular_position":{"a0":-69.31704,"a1":137.62952,"a2":19.832787},"angular_velocity":{"a0":0,"a1":0,)"
      R"("a2":0},"body_orientation":{"x":-0.01940918,"y":0.7026367,"z":0.00048828125,"w":0.7113037},"cursor_position":)" +
      vectorText(place_m) + R"(,"cursor_velocity":)" + vectorText({-0.011969013, 0.0012009288, -4.3197e-2});
  text +=
      modern
          ? R"(,"current_cursor_force":{"x":0.0,"y":0.0,"z":0.0},"control_domain":"cartesian","control_mode":"idle",)"
            R"("transform":{"position":{"x":0,"y":0,"z":0},"rotation":{"w":1,"x":0,"y":0,"z":0}}})"
          : R"(,"mode":"idle"})";
  return text + R"(,"status":{"calibrated":false,"in_use":true,"power_supply":)" + word(powered) + R"(,"ready":)" +
         word(ready) + R"(,"started":true}})";
}

Result<void> EmulatedWire::open(const std::atomic<bool>& cancelled) {
  count();
  if (cancelled) return fail(ErrorCode::Cancelled, "cancelled");
  if (!service_.connect(clock_.now())) return fail(ErrorCode::NotFound, "the emulator does not run");
  unread_.clear();
  return {};
}

void EmulatedWire::close() noexcept {
  service_.disconnect();
}

Result<std::size_t> EmulatedWire::receive(std::span<char> to) RELIEVO_RT {
  count();
  const std::uint64_t before = threadAllocations();
  unread_ += service_.take(clock_.now());
  allocations += threadAllocations() - before;
  if (unread_.empty() && !service_.connected()) return fail(ErrorCode::Lost, "the emulator has gone");
  const std::size_t bytes = std::min({to.size(), unread_.size(), most_bytes});
  std::copy_n(unread_.begin(), bytes, to.begin());
  unread_.erase(0, bytes);
  return bytes;
}

Result<std::size_t> EmulatedWire::send(std::span<const char> bytes) RELIEVO_RT {
  count();
  if (!service_.connected()) return fail(ErrorCode::Lost, "the emulator has gone");
  if (service_.deaf) return 0;
  const std::uint64_t before = threadAllocations();
  const std::size_t sent = std::min(bytes.size(), most_bytes);
  service_.receive({bytes.data(), sent}, clock_.now());
  allocations += threadAllocations() - before;
  return sent;
}

void EmulatedWire::count() {
  if (before_each) before_each();
  if (verbs_left > 0 && --verbs_left == 0 && at_zero) at_zero();
}

}  // namespace relievo::test

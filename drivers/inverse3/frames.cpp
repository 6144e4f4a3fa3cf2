// SPDX-License-Identifier: Apache-2.0
// RFC 6455, section 5.2: the layout of a frame; 5.4: fragmentation; 5.5: control frames.
#include "drivers/inverse3/frames.h"

#include <algorithm>
#include <cstring>

namespace relievo::inverse3 {
namespace {

constexpr unsigned kFinal = 0x80, kReserved = 0x70, kKind = 0x0F, kMasked = 0x80, kLength = 0x7F;
constexpr std::size_t kLength16 = 126, kMostShort = 125;

bool isKnown(unsigned kind) RELIEVO_RT {
  return kind <= 2 || (kind >= 8 && kind <= 10);
}

bool isControl(Opcode kind) RELIEVO_RT {
  return kind >= Opcode::Close;
}

std::size_t bigEndian(const char* bytes, std::size_t count) RELIEVO_RT {
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8U | static_cast<unsigned char>(bytes[i]);
  return value;
}

}  // namespace

void FrameReader::clear() RELIEVO_RT {
  begin_ = end_ = pieced_ = 0;
  piecing_.reset();
  broken_ = false;
}

std::span<char> FrameReader::room() RELIEVO_RT {
  if (broken_) begin_ = end_;  // nothing of it will be read
  if (begin_ > 0) std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  return std::span(bytes_).subspan(end_);
}

std::optional<Message> FrameReader::next() RELIEVO_RT {
  while (!broken_) {
    const auto head = header();
    if (!head || end_ - begin_ < head->bytes + head->payload) return std::nullopt;
    const std::string_view payload(bytes_.data() + begin_ + head->bytes, head->payload);
    begin_ += head->bytes + head->payload;
    if (isControl(head->kind)) return Message{head->kind, payload};
    if (const auto whole = add(*head, payload)) return whole;
  }
  return std::nullopt;
}

// Empty as well if it has not arrived whole.
std::optional<FrameReader::Header> FrameReader::header() RELIEVO_RT {
  const std::size_t there = end_ - begin_;
  if (there < 2) return std::nullopt;
  const unsigned first = static_cast<unsigned char>(bytes_[begin_]);
  const unsigned second = static_cast<unsigned char>(bytes_[begin_ + 1]);
  if ((first & kReserved) != 0 || !isKnown(first & kKind) || (second & kMasked) != 0) return breach();
  Header head{.kind = static_cast<Opcode>(first & kKind),
              .final = (first & kFinal) != 0,
              .bytes = 2,
              .payload = second & kLength};
  if (isControl(head.kind) && (!head.final || head.payload > kMostShort)) return breach();
  if (head.payload > kMostShort) {
    const bool two = head.payload == kLength16;
    const std::size_t more = two ? 2 : 8;
    if (there < 2 + more) return std::nullopt;
    head.bytes = 2 + more;
    head.payload = bigEndian(bytes_.data() + begin_ + 2, more);
    // The shortest form of a length is the only right one.
    if (head.payload <= (two ? kMostShort : std::size_t{0xFFFF})) return breach();
  }
  if (head.payload > kMostMessage) return breach();
  return head;
}

std::optional<Message> FrameReader::add(const Header& head, std::string_view payload) RELIEVO_RT {
  const bool goes_on = head.kind == Opcode::Continuation;
  if (goes_on != piecing_.has_value()) return breach();
  if (!goes_on && head.final) return Message{head.kind, payload};
  if (!goes_on) {
    piecing_ = head.kind;
    pieced_ = 0;
  }
  if (pieced_ + payload.size() > pieces_.size()) return breach();
  std::copy(payload.begin(), payload.end(), pieces_.begin() + static_cast<std::ptrdiff_t>(pieced_));
  pieced_ += payload.size();
  if (!head.final) return std::nullopt;
  const Message whole{*piecing_, {pieces_.data(), pieced_}};
  piecing_.reset();
  return whole;
}

std::nullopt_t FrameReader::breach() RELIEVO_RT {
  broken_ = true;
  return std::nullopt;
}

std::size_t writeFrame(Opcode kind, std::string_view payload, std::uint32_t mask, std::span<char> out) RELIEVO_RT {
  const bool two = payload.size() > kMostShort;
  const std::size_t head = two ? 8 : 6;
  if (payload.size() > 0xFFFF || out.size() < head + payload.size()) return 0;
  out[0] = static_cast<char>(kFinal | static_cast<unsigned>(kind));
  out[1] = static_cast<char>(kMasked | (two ? kLength16 : payload.size()));
  if (two) {
    out[2] = static_cast<char>(payload.size() >> 8U);
    out[3] = static_cast<char>(payload.size() & 0xFFU);
  }
  std::array<char, 4> key{};
  std::memcpy(key.data(), &mask, key.size());
  std::memcpy(&out[head - key.size()], key.data(), key.size());
  for (std::size_t i = 0; i < payload.size(); ++i) out[head + i] = static_cast<char>(payload[i] ^ key[i % 4]);
  return head + payload.size();
}

}  // namespace relievo::inverse3

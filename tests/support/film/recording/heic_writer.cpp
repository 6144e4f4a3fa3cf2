// SPDX-License-Identifier: Apache-2.0
#include "tests/support/film/recording/heic_writer.h"

#include <stdexcept>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo::test {
namespace {

std::string number(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return text;
}
std::string box(const std::string& type, const std::string& content) {
  return number(static_cast<std::uint32_t>(content.size() + 8), 4) + type + content;
}
std::string fullBox(const std::string& type, const std::string& content, std::uint32_t version = 0) {
  return box(type, number(version << 24, 4) + content);
}

}  // namespace

HevcPicture hevcPicture(const std::function<std::uint32_t(int, int, int, int)>& sample, int cols, int rows) {
  const TemporaryFolder folder;
  makeClip(folder / "a.mp4",
           {{.codec = "libx265",
             .pix_fmt = "yuv420p",
             .width = cols,
             .height = rows,
             .frames = 1,
             .range = ColorRange::Full,
             .sample = sample,
             .options = {{"crf", "4"}, {"preset", "ultrafast"}, {"x265-params", "log-level=error"}}}});
  const auto source = makeFfmpegSource();
  if (!source->open(folder / "a.mp4")) throw std::runtime_error("the coded picture cannot be opened");
  const StreamInfo& stream = source->streams().at(0);
  const Packet packet = source->read().value().value();
  return {{stream.extradata.begin(), stream.extradata.end()}, {packet.data, packet.data + packet.bytes}, cols, rows};
}

std::string heicFile(const HevcPicture& color, const HevcPicture& depth, const HeicLayout& how) {
  const auto sizeOf = [](const HevcPicture& of) {
    return number(static_cast<std::uint32_t>(of.cols), 4) + number(static_cast<std::uint32_t>(of.rows), 4);
  };
  const std::string properties = box(
      "ipco", box("hvcC", color.parameters) + box("hvcC", depth.parameters) + fullBox("ispe", sizeOf(color)) +
                  box("irot", number(static_cast<std::uint32_t>(how.quarter_turns), 1)) +
                  fullBox("auxC", std::string("urn:mpeg:hevc:2015:auxid:2\0", 27)) + fullBox("ispe", sizeOf(depth)));
  // Essential properties have the high bit.
  const std::string of_color = number(1, 2) + "\x03" + "\x81\x03\x84";
  const std::string of_depth =
      number(2, 2) + (how.auxiliary ? "\x04" + std::string("\x82\x06\x84\x05") : "\x02" + std::string("\x82\x06"));
  const std::string associations = fullBox("ipma", number(2, 4) + of_color + of_depth);
  const auto entry = [](std::uint32_t item, const std::string& type, const std::string& more) {
    return fullBox("infe", number(item, 2) + number(0, 2) + type + std::string(1, '\0') + more, 2);
  };
  const bool with_xmp = !how.xmp.empty();
  std::string items = entry(1, "hvc1", "") + entry(2, "hvc1", "");
  if (with_xmp) items += entry(3, "mime", std::string("application/rdf+xml\0", 20));
  std::string references;
  if (how.auxiliary) references += box("auxl", number(2, 2) + number(1, 2) + number(1, 2));
  if (with_xmp) references += box("cdsc", number(3, 2) + number(1, 2) + number(2, 2));
  const auto meta = [&](std::uint32_t begin) {
    std::string places = number(0x4400, 2) + number(with_xmp ? 3 : 2, 2);
    std::uint32_t at = begin, item = 0;
    for (const std::string& data : {color.picture, depth.picture, how.xmp}) {
      if (data.empty()) break;
      places += number(++item, 2) + number(0, 2) + number(1, 2) + number(at, 4) +
                number(static_cast<std::uint32_t>(data.size()), 4);
      at += static_cast<std::uint32_t>(data.size());
    }
    return fullBox("meta", fullBox("hdlr", number(0, 4) + "pict" + std::string(13, '\0')) +
                               fullBox("pitm", number(1, 2)) + fullBox("iloc", places) +
                               fullBox("iinf", number(with_xmp ? 3 : 2, 2) + items) +
                               (references.empty() ? "" : fullBox("iref", references)) +
                               box("iprp", properties + associations) + how.groups);
  };
  const std::string type = box("ftyp", "heic" + number(0, 4) + "mif1heic");
  const auto begin = static_cast<std::uint32_t>(type.size() + meta(0).size() + 8);
  return type + meta(begin) + box("mdat", color.picture + depth.picture + how.xmp);
}

std::string heicBox(const std::string& type, const std::string& content) {
  return box(type, content);
}

std::string heicGroup(const std::string& type, const std::vector<std::uint32_t>& items) {
  std::string content = number(900, 4) + number(static_cast<std::uint32_t>(items.size()), 4);
  for (const std::uint32_t item : items) content += number(item, 4);
  return fullBox(type, content);
}

}  // namespace relievo::test

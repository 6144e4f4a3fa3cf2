// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/part_languages.h"

#include <algorithm>
#include <span>

#include "drivers/ffmpeg/opening/seeks.h"

namespace relievo::ffmpeg {
namespace {

bool areOfOneKind(const AVStream* a, const AVStream* b) noexcept {
  return a->codecpar->codec_type == b->codecpar->codec_type;
}

}  // namespace

bool lacksLanguages(const AVFormatContext& list) noexcept {
  return isListOfMp4(list) && std::ranges::any_of(std::span(list.streams, list.nb_streams), [](const AVStream* stream) {
           return stream->codecpar->codec_type == AVMEDIA_TYPE_AUDIO &&
                  av_dict_get(stream->metadata, "language", nullptr, 0) == nullptr;
         });
}

void takeLanguages(AVFormatContext& list, AVIOContext& part) noexcept {
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) return;
  context->pb = &part;
  context->flags |= AVFMT_FLAG_IGNIDX;  // the head alone, where one file holds all parts
  context->interrupt_callback = list.interrupt_callback;
  if (avformat_open_input(&context, nullptr, av_find_input_format("mov"), nullptr) < 0) return;
  const std::span to(list.streams, list.nb_streams), from(context->streams, context->nb_streams);
  if (std::ranges::equal(to, from, areOfOneKind)) {
    for (std::size_t i = 0; i < to.size(); ++i) {
      for (const char* const key : {"language", "handler_name"}) {
        const AVDictionaryEntry* const tag = av_dict_get(from[i]->metadata, key, nullptr, 0);
        if (tag != nullptr) av_dict_set(&to[i]->metadata, key, tag->value, AV_DICT_DONT_OVERWRITE);
      }
    }
  }
  avformat_close_input(&context);
}

}  // namespace relievo::ffmpeg

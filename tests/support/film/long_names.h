// SPDX-License-Identifier: Apache-2.0
// Names of films that are hard to show.
#pragma once

namespace relievo::test {

// 200 letters.
inline constexpr const char* kLongName =
    "A long name of a film that goes on and on until nobody can read it any more because there is no room "
    "left on the screen at all, or so it seems to whoever has to put it there (director's cut, 2026).mkv";
inline constexpr const char* kJapaneseName =
    "短い映画 とても長い名前のテスト 立体映像で触れる顔の映画 第一部 その一 短い映画 とても長い名前のテスト 第二部.mkv";
inline constexpr const char* kArabicName =
    "فيلم قصير عن الوجه الذي يمكنك لمسه بإصبعك وأنت تشاهده في البيت مع الأسرة كلها.mkv";

}  // namespace relievo::test

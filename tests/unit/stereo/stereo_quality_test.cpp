// SPDX-License-Identifier: Apache-2.0
// How good the depth from two views is, beside that of OpenCV's matcher alone: on the sample film as two coded views,
// and on Middlebury's still lifes where they are at hand (RELIEVO_STEREO_PAIRS/NAME/{im2.png,im6.png,disp2.pgm}).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/author/sample/sample_renderer.h"
#include "app/author/sample/sample_scene.h"
#include "app/lab/film/parallel.h"
#include "app/lab/film/right_view.h"
#include "app/media/pair_reader.h"
#include "app/stereo/stereo_depth.h"
#include "app/stereo/stereo_survey.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"

namespace relievo {
namespace {

// Disparities in pixels, row by row; unknown where it is not finite.
struct Truth {
  int cols = 0, rows = 0;
  std::vector<float> pixels;
};

struct Quality {
  double wrong = 0;       // share of the known pixels off by more than 2 pixels
  double median = 0;      // pixels
  double lost_edges = 0;  // share of the steps of over 4 pixels that the map does not have within 3 pixels
};

// Whether the row of the map crosses the middle of the true step between columns `c` and `c` + 1 in the same direction,
// at most 3 pixels away.
bool hasEdge(const Truth& truth, const DisparityMap& map, int c, int r) {
  const float before = truth.pixels[map.at(c, r)], after = truth.pixels[map.at(c + 1, r)];
  const float middle = 0.5F * (before + after);
  for (int x = std::max(0, c - 3); x <= std::min(map.cols - 2, c + 3); ++x) {
    const float a = map.pixels[map.at(x, r)] - middle, b = map.pixels[map.at(x + 1, r)] - middle;
    if (after > before ? a <= 0 && b > 0 : a > 0 && b <= 0) return true;
  }
  return false;
}

Quality qualityOf(const DisparityMap& map, const Truth& truth) {
  std::vector<double> errors;
  int edges = 0, lost = 0;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      const float known = truth.pixels[map.at(c, r)];
      if (!std::isfinite(known)) continue;
      errors.push_back(std::abs(static_cast<double>(map.pixels[map.at(c, r)]) - static_cast<double>(known)));
      if (c + 1 == map.cols || !(std::abs(truth.pixels[map.at(c + 1, r)] - known) > 4)) continue;
      if (!std::isfinite(truth.pixels[map.at(c + 1, r)])) continue;
      ++edges;
      lost += hasEdge(truth, map, c, r) ? 0 : 1;
    }
  }
  const auto wrong = static_cast<double>(std::ranges::count_if(errors, [](double e) { return e > 2; }));
  std::ranges::nth_element(errors, errors.begin() + std::ssize(errors) / 2);
  return {wrong / static_cast<double>(errors.size()), errors[errors.size() / 2], lost / std::max(1.0, 1.0 * edges)};
}

void tell(const std::string& name, const char* by, const Quality& q) {
  std::printf("%-18s %-12s wrong by over 2 pixels %6.2f %%, median %.3f pixels, edges lost %5.1f %%\n", name.c_str(),
              by, 100 * q.wrong, q.median, 100 * q.lost_edges);
}

struct Both {
  Quality ours, alone;
};
Both compare(const std::string& name, const ViewPicture& left, const ViewPicture& right, DisparityRange range,
             const Truth& truth) {
  const Both both{qualityOf(disparityOf(left, right, range), truth),
                  qualityOf(plainDisparityOf(left, right, range), truth)};
  tell(name, "relievo", both.ours);
  tell(name, "SGBM alone", both.alone);
  return both;
}

// A moment of the sample film: the left view, and its exact disparity.
struct Moment {
  Frame left;
  Truth truth;
};
Moment momentOf(double t_s, int cols, int rows) {
  constexpr double kBehind = -10, kReach = 30;  // pixels: of the far plane, and from there to the near one
  SamplePicture picture{.cols = cols, .rows = rows, .rgb = {}, .depth = {}};
  renderSample(t_s, 2, picture);
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(std::move(picture.rgb));
  Moment moment;
  moment.left.width = cols;
  moment.left.height = rows;
  moment.left.model = ColorModel::Rgb;
  moment.left.range = ColorRange::Full;
  moment.left.plane_count = 1;
  moment.left.planes[0] = {bytes->data(), std::ptrdiff_t{3} * cols};
  for (std::uint8_t i = 0; i < 3; ++i) moment.left.components[i] = {.offset_bytes = i, .step_bytes = 3};
  moment.left.owner = bytes;
  moment.truth = {cols, rows, std::vector<float>(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows))};
  inParallel(static_cast<std::size_t>(rows), [&](std::size_t r) {
    for (int c = 0; c < cols; ++c) {
      const double x = ((c + 0.5) / cols - 0.5) * SampleFilm::kWidthMm;
      const double y = (0.5 - (static_cast<double>(r) + 0.5) / rows) * SampleFilm::kHeightMm;
      moment.truth.pixels[r * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c)] =
          static_cast<float>(kBehind + kReach * sampleSceneHeight(x, y, t_s) / SampleFilm::kDepthMm);
    }
  });
  return moment;
}

// Y, U or V of BT.601, limited range.
std::uint32_t yuvOf(const Frame& rgb, int component, int c, int r) {
  const auto at = [&](int k) { return static_cast<double>(test::sampleAt(rgb, k, c, r)); };
  const double red = at(0), green = at(1), blue = at(2);
  const double y = 0.299 * red + 0.587 * green + 0.114 * blue;
  const double value = component == 0   ? 16 + y * 219 / 255
                       : component == 1 ? 128 + 0.564 * (blue - y) * 224 / 255
                                        : 128 + 0.713 * (red - y) * 224 / 255;
  return static_cast<std::uint32_t>(std::lround(value));
}

// The pair after a film of two views at crf 18 has been written and read.
FramePair coded(const Frame& left, const Frame& right, const std::string& path) {
  test::makeClip(path, {{.codec = "libx264",
                         .pix_fmt = "yuv420p",
                         .width = 2 * left.width,
                         .height = left.height,
                         .frames = 1,
                         .range = ColorRange::Limited,
                         .sample =
                             [&](int component, int c, int r, int) {
                               const int x = component == 0 ? c : 2 * c, y = component == 0 ? r : 2 * r;
                               return yuvOf(x < left.width ? left : right, component, x % left.width, y);
                             },
                         .options = {{"crf", "18"}}}});
  PairReader reader(kFfmpeg);
  EXPECT_TRUE(reader.open({.url = path, .packing = Packing::StereoSideBySide}).has_value());
  return reader.next().value().value();
}

TEST(StereoQuality, OfTheSampleFilmAsTwoCodedViews) {
  const test::TemporaryFolder folder;
  double ours = 0, alone = 0;
  for (const double t_s : {2.0, 9.0}) {
    const Moment moment = momentOf(t_s, 1080, 720);
    const FramePair views = coded(moment.left, rightViewOf(moment.left, moment.truth.pixels), folder / "views.mkv");
    StereoSurvey survey;
    ASSERT_TRUE(survey.add(views.color, views.right).has_value());
    const StereoPlan plan = survey.finish().value();
    EXPECT_FALSE(plan.views_swapped);
    EXPECT_LT(plan.shots[0].alignment.reach(plan.cols, plan.rows), 1) << "the views lie row by row";
    const Both both = compare("sample at " + std::to_string(static_cast<int>(t_s)) + " s", readView(views.color),
                              readView(views.right), plan.shots[0].range, moment.truth);
    EXPECT_LT(both.ours.median, 0.25);
    EXPECT_LE(both.ours.lost_edges, 0.09);
    ours += both.ours.wrong;
    alone += both.alone.wrong;
  }
  EXPECT_LE(ours / 2, 0.011);
  EXPECT_LE(ours, 0.3 * alone);
}

Truth readDisparity(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string kind;
  Truth truth;
  int highest = 0;
  file >> kind >> truth.cols >> truth.rows >> highest;
  file.get();
  std::vector<char> codes(static_cast<std::size_t>(truth.cols) * static_cast<std::size_t>(truth.rows));
  file.read(codes.data(), std::ssize(codes));
  for (const char code : codes) {  // quarters of a pixel, 0 where it is unknown
    const auto quarters = static_cast<std::uint8_t>(code);
    truth.pixels.push_back(quarters == 0 ? std::nanf("") : static_cast<float>(quarters) / 4);
  }
  return truth;
}

ViewPicture readPicture(const std::string& path) {
  PairReader reader(kFfmpeg);
  EXPECT_TRUE(reader.open({.url = path}).has_value());
  return readView(reader.next().value().value().color);
}

void compareStill(const std::string& name) {
  const char* const pairs = std::getenv("RELIEVO_STEREO_PAIRS");
  const std::string folder = std::string(pairs != nullptr ? pairs : RELIEVO_TEST_DATA) + "/" + name;
  for (const char* file : {"/im2.png", "/im6.png", "/disp2.pgm"}) {
    if (!std::filesystem::exists(folder + file)) GTEST_SKIP() << folder << file << " is not at hand";
  }
  const Both both = compare(name, readPicture(folder + "/im2.png"), readPicture(folder + "/im6.png"), {0, 60},
                            readDisparity(folder + "/disp2.pgm"));
  EXPECT_LE(both.ours.wrong, 0.56 * both.alone.wrong);
}

TEST(StereoQuality, OfMiddleburysCones) {
  compareStill("cones");
}
TEST(StereoQuality, OfMiddleburysTeddy) {
  compareStill("teddy");
}

}  // namespace
}  // namespace relievo

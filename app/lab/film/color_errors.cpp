// SPDX-License-Identifier: Apache-2.0
#include "app/lab/film/color_errors.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/lab/chart/csv_table.h"
#include "app/lab/truth/true_surface.h"
#include "app/media/reading/picture_look.h"
#include "app/scene/color/color_curve.h"
#include "platform/quantile.h"

namespace relievo {
namespace {

constexpr int kEntries = 512;
constexpr double kTop = 65535;

std::vector<PictureColor> entriesOf(DepthCode code) {
  constexpr double kRed = 0.2126, kBlue = 0.0722;  // BT.709
  const ColorCurve& curve = curveOf(code);
  std::vector<PictureColor> entries;
  for (int i = 0; i < kEntries; ++i) {
    const YuvColor color = curve.at(i / (kEntries - 1.0));
    const double y = static_cast<double>(color.y);
    const double red = y + 2 * (1 - kRed) * static_cast<double>(color.v);
    const double blue = y + 2 * (1 - kBlue) * static_cast<double>(color.u);
    entries.push_back({red, (y - kRed * red - kBlue * blue) / (1 - kRed - kBlue), blue});
  }
  return entries;
}

bool isAtStep(const HeightField& truth, int c, int r) {
  constexpr int kReach = 3;
  constexpr double kStepMm = 0.012 * TrueSurface::kVolume.depth_mm;
  const auto steps = [&](int c0, int r0, int right, int down) {
    const int c1 = c0 + right, r1 = r0 + down;
    if (std::min(c0, r0) < 0 || c1 >= truth.cols() || r1 >= truth.rows()) return false;
    return std::abs(truth.heightMm(c1, r1) - truth.heightMm(c0, r0)) > kStepMm;
  };
  for (int i = -kReach; i < kReach; ++i) {
    if (steps(c + i, r, 1, 0) || steps(c, r + i, 0, 1)) return true;
  }
  return false;
}

// Gray of 16 bits: the place on the curve of `meaning.code`, by RGB and the chroma sample that covers it.
Frame naivelyRead(const Frame& coded, const DepthCalibration& meaning) {
  const std::vector<PictureColor> entries = entriesOf(meaning.code);
  auto codes = std::make_shared<std::vector<std::uint16_t>>();
  for (int r = 0; r < coded.height; ++r) {
    for (int c = 0; c < coded.width; ++c) {
      const PictureColor here = colorAt(coded, c, r);
      const auto distance = [&](const PictureColor& entry) {  // squared
        const double red = entry.red - here.red, green = entry.green - here.green, blue = entry.blue - here.blue;
        return red * red + green * green + blue * blue;
      };
      const auto nearest = std::ranges::min_element(entries, {}, distance) - entries.begin();
      codes->push_back(static_cast<std::uint16_t>(std::lround(kTop * static_cast<double>(nearest) / (kEntries - 1))));
    }
  }
  return grayFrame(std::move(codes), coded.width, coded.height);
}

}  // namespace

void ColorErrors::add(const Frame& coded, const DepthCalibration& meaning, const HeightField& own,
                      const HeightField& truth) {
  DepthCalibration gray = meaning;
  gray.code = DepthCode::Luma;
  gray.bits = 16;
  const Frame read = naivelyRead(coded, meaning);
  const auto naive = HeightField::make(read, gray, TrueSurface::kVolume);
  if (!naive) return;
  for (int r = 0; r < truth.rows(); ++r) {
    for (int c = 0; c < truth.cols(); ++c) {
      const bool at_step = isAtStep(truth, c, r);
      for (const auto& [field, errors] : {std::pair{&own, &errors_[0]}, {&*naive, &errors_[1]}}) {
        const double mm = std::abs(field->heightMm(c, r) - truth.heightMm(c, r));
        if (std::isnan(mm)) continue;
        const auto error = static_cast<float>(mm / TrueSurface::kVolume.depth_mm);
        errors->all.push_back(error);
        if (at_step) errors->edges.push_back(error);
      }
    }
  }
}

double ColorErrors::p99(Reading reading, bool edges) const {
  const Errors& of = errors_[static_cast<std::size_t>(reading)];
  std::vector<float> errors = edges ? of.edges : of.all;
  return static_cast<double>(quantile(errors, 0.99));
}

Outcome<void> writeColorErrors(const std::vector<ColorErrorsRow>& rows, const std::string& folder) {
  using enum ColorErrors::Reading;
  CsvTable table({"steps", "crf", "p99", "naive_p99", "edges_p99", "naive_edges_p99"});
  for (const ColorErrorsRow& row : rows) {
    const ColorErrors& errors = *row.errors;
    table.row({row.steps.c_str(), row.crf, errors.p99(Own, false), errors.p99(Naive, false), errors.p99(Own, true),
               errors.p99(Naive, true)});
  }
  return table.write(folder + "/bitrate-colors.csv");
}

}  // namespace relievo

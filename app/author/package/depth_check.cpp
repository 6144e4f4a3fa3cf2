// SPDX-License-Identifier: Apache-2.0
#include "app/author/package/depth_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/scene/display_volume.h"
#include "app/scene/height_field.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kMostN = 20;  // the whole depth of the box
constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

// Bounds of a step. Of the film's codes: what people notice of a force of 5 N (6 %) in the median, and a twentieth of
// the box's depth at the 99th percentile. Enhancement moves what is noise, too.
struct Bounds {
  double median_n, p99_n, moved;
};
constexpr Bounds kCodes{.median_n = 0.3, .p99_n = 1, .moved = 0.05}, kEnhanced{.median_n = 1, .p99_n = 20, .moved = 1};

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

bool exceeds(const StepErrors& errors, const Bounds& most) {
  return errors.quantile(0.5) > most.median_n || errors.quantile(0.99) > most.p99_n || errors.moved() > most.moved;
}

std::string stepText(const char* name, const StepErrors& errors) {
  if (errors.empty()) return "";
  return print(", %s %.3f and %.3f", name, errors.quantile(0.5), errors.quantile(0.99));
}

// Of every so many columns and rows one sample is compared. An odd step meets each place of the codecs' blocks.
int stepOf(int width, int height) {
  constexpr double kSamples = 20'000;
  return static_cast<int>(std::sqrt(static_cast<double>(width) * height / kSamples)) | 1;
}

template <class HeightAt>
std::vector<float> sampled(int width, int height, const HeightAt& height_at) {
  const int step = stepOf(width, height);
  std::vector<float> heights;
  for (int r = step / 2; r < height; r += step) {
    for (int c = step / 2; c < width; c += step) heights.push_back(height_at(c, r));
  }
  return heights;
}

std::vector<float> heightsOf(const Frame& depth, const DepthCalibration& calibration) {
  const auto field = HeightField::make(depth, calibration, DisplayVolume::forPicture(depth.width, depth.height));
  if (!field) return {};  // the coder reports the error
  return sampled(depth.width, depth.height, [&](int c, int r) { return static_cast<float>(field->heightMm(c, r)); });
}

void addAll(const std::vector<float>& before, const std::vector<float>& after, StepErrors& errors) {
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) errors.add(before[i], after[i]);
}

}  // namespace

double newtonsOf(double height_mm) noexcept {
  constexpr double kStiffnessNPerMm = 0.5;  // the player's
  return height_mm * kStiffnessNPerMm;
}

void StepErrors::add(float before, float after) {
  ++samples_;
  const bool hole = std::isnan(before), hole_after = std::isnan(after);
  moved_ += hole != hole_after ? 1 : 0;
  if (hole || hole_after) return;
  of_millinewton_.resize(static_cast<std::size_t>(1000 * kMostN) + 1);
  const double newtons = newtonsOf(std::abs(static_cast<double>(before) - static_cast<double>(after)));
  ++of_millinewton_[static_cast<std::size_t>(1000 * std::min(newtons, kMostN))];
}

double StepErrors::quantile(double share) const {
  std::uint64_t counted = 0, passed = 0;
  for (const std::uint64_t count : of_millinewton_) counted += count;
  for (std::size_t i = 0; i < of_millinewton_.size(); ++i) {
    passed += of_millinewton_[i];
    if (static_cast<double>(passed) >= share * static_cast<double>(counted)) return 1e-3 * static_cast<double>(i);
  }
  return 0;
}

double StepErrors::moved() const {
  return share(moved_, samples_);
}

void ReliefShares::add(float height_mm) {
  ++samples_;
  holes_ += std::isnan(height_mm) ? 1 : 0;
  ends_ += height_mm <= 0 || static_cast<double>(height_mm) >= DisplayVolume::kDefaultDepthMm ? 1 : 0;
}

double ReliefShares::holes() const {
  return share(holes_, samples_);
}

double ReliefShares::ends() const {
  return share(ends_, samples_);
}

DepthCheck::DepthCheck(const DepthCalibration& source, const std::optional<DepthCalibration>& enhanced,
                       const DepthCalibration& film)
    : source_(source), enhanced_(enhanced), of_code_(std::size_t{1} << film.bits) {
  for (std::uint32_t code = 0; code < of_code_.size(); ++code) {
    const double s = (code - film.lowCode()) / (film.highCode() - film.lowCode());
    const double height = heightMm(film, s, DisplayVolume::kDefaultDepthMm);
    of_code_[code] = film.invalid.contains(code) ? kHole : static_cast<float>(height);
  }
}

void DepthCheck::read(const Frame& depth) {
  read_.push_back(heightsOf(depth, source_));
  for (const float height : read_.back()) loss_.source.add(height);
}

void DepthCheck::write(const Frame& depth, const DepthPicture& codes) {
  if (read_.empty()) return;
  Picture picture{.source = std::move(read_.front()), .coded = {}};
  read_.pop_front();
  picture.coded = sampled(codes.width, codes.height, [&](int c, int r) {
    return of_code_[codes.codes[static_cast<std::size_t>(r) * static_cast<std::size_t>(codes.width) +
                                static_cast<std::size_t>(c)]];
  });
  if (enhanced_) {
    const Heights enhanced = heightsOf(depth, *enhanced_);
    addAll(picture.source, enhanced, loss_.enhancing);
    addAll(enhanced, picture.coded, loss_.rounding);
  } else {
    addAll(picture.source, picture.coded, loss_.rounding);
  }
  const std::lock_guard lock(mutex_);
  coded_.push_back(std::move(picture));
}

Result<void> DepthCheck::decode(const AVPacket* packet) {
  return decoder_.decode(packet, [this](const PacketDecoder::Picture& picture) { return compare(*picture); });
}

bool DepthCheck::compare(const AVFrame& decoded) {
  Picture expected;
  {
    const std::lock_guard lock(mutex_);
    if (coded_.empty()) return false;
    expected = std::move(coded_.front());
    coded_.pop_front();
  }
  const bool bytes = of_code_.size() == 256;
  const Heights film = sampled(decoded.width, decoded.height, [&](int c, int r) {
    const std::uint8_t* const row = decoded.data[0] + static_cast<std::ptrdiff_t>(r) * decoded.linesize[0];
    const std::size_t code = bytes ? row[c] : row[2 * c] | row[2 * c + 1] << 8;
    return of_code_[std::min(code, of_code_.size() - 1)];
  });
  addAll(expected.coded, film, loss_.coding);
  addAll(expected.source, film, loss_.all);
  for (const float height : film) loss_.film.add(height);
  return film.size() == expected.coded.size();
}

const char* whyTooFar(const DepthLoss& loss) noexcept {
  if (exceeds(loss.enhancing, kEnhanced)) {
    return "enhancement changes the force by over 1 N in the median: leave out --enhance";
  }
  if (exceeds(loss.rounding, kCodes)) {
    return "its codes are too coarse for the depth (over .3 N in the median, or 1 N at p99): try more --depth-bits";
  }
  if (exceeds(loss.coding, kCodes)) {
    return "coding changes the force (by over .3 N in the median or 1 N at p99), or makes holes or closes them (over 5 "
           "%): try "
           "--depth-crf 0";
  }
  return nullptr;
}

std::string toText(const DepthLoss& loss) {
  if (loss.all.empty()) return "";
  const auto percent = [](double share) { return 100 * share; };
  const std::string text = print("  measured in the film: force off by %.3f N in the median, %.3f N at p99",
                                 loss.all.quantile(0.5), loss.all.quantile(0.99)) +
                           stepText("enhancing", loss.enhancing) + stepText("rounding", loss.rounding) +
                           stepText("coding", loss.coding);
  return text +
         print("\n    holes %.1f %%, in the source %.1f %%; at an end of the range %.1f %%, in the source %.1f %%\n",
               percent(loss.film.holes()), percent(loss.source.holes()), percent(loss.film.ends()),
               percent(loss.source.ends()));
}

}  // namespace relievo

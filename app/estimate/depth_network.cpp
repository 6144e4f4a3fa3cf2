// SPDX-License-Identifier: Apache-2.0
#include "app/estimate/depth_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "app/estimate/network_engine.h"
#include "app/estimate/onnx_input.h"
#include "platform/files/answered_file.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Error kNotDepth{ErrorCode::Unsupported, 0, "the network must give depth in one channel"};

constexpr Error kOneSize{ErrorCode::InvalidArgument, 0, "give that as --depth-size, or leave it out"};

constexpr const char* kTooLarge = "is larger than an ONNX model can be";

// protobuf allows no larger message.
constexpr std::size_t kMostBytes = (std::size_t{1} << 31U) - 1;

Result<std::vector<std::uint8_t>> readNetwork(const std::string& path) {
  const auto file = AnsweredFile::open(path);
  if (!file) return std::unexpected(file.error());
  if (!file->regular()) return fail(ErrorCode::Unsupported, "is a device or a pipe; name a file");
  const auto size = file->bytes();
  if (!size) return std::unexpected(size.error());
  if (*size > kMostBytes) return fail(ErrorCode::Exhausted, kTooLarge);
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> part(std::size_t{1} << 20U);
  for (;;) {
    const auto got = file->readSome(bytes.size(), part);
    if (!got) return std::unexpected(got.error());
    if (*got == 0) return bytes;
    if (bytes.size() + *got > kMostBytes) return fail(ErrorCode::Exhausted, kTooLarge);  // it grows
    bytes.insert(bytes.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(*got));
  }
}

int inPatches(double length) {
  return std::max(static_cast<int>(std::lround(length / DepthNetwork::kPatch)), 1) * DepthNetwork::kPatch;
}

// The network's own size, else the user's, else the picture's shape.
cv::Size inputSize(const OnnxInput& own, std::optional<std::pair<int, int>> wished, int cols, int rows) {
  const double scale = static_cast<double>(DepthNetwork::kLongSide) / std::max(cols, rows);
  const auto [wide, high] = wished.value_or(std::pair(inPatches(scale * cols), inPatches(scale * rows)));
  return {own.cols > 0 ? own.cols : wide, own.rows > 0 ? own.rows : high};
}

// The resolution of the network's output, in the picture's shape, and no finer than the picture.
cv::Size outcomeSize(cv::Size network, int cols, int rows) {
  const double scale =
      std::min(std::max(static_cast<double>(network.width) / cols, static_cast<double>(network.height) / rows), 1.0);
  return {std::max(static_cast<int>(std::lround(scale * cols)), 2),
          std::max(static_cast<int>(std::lround(scale * rows)), 2)};
}

// Red, green, blue, one plane after the other, each by its mean and deviation over many photographs (ImageNet).
NetworkPlanes planesOf(const RawPicture& picture, cv::Size size) {
  const cv::Mat whole(picture.rows, picture.cols, CV_8UC3, const_cast<std::uint8_t*>(picture.bytes.data()));
  cv::Mat scaled, shares;
  const bool smaller = size.width < picture.cols || size.height < picture.rows;
  cv::resize(whole, scaled, size, 0, 0, smaller ? cv::INTER_AREA : cv::INTER_CUBIC);
  scaled.convertTo(shares, CV_32F, 1.0 / 255);
  shares -= cv::Scalar(0.485, 0.456, 0.406);
  cv::divide(shares, cv::Scalar(0.229, 0.224, 0.225), shares);
  NetworkPlanes planes{size.width, size.height, std::vector<float>(3 * shares.total())};
  std::array<cv::Mat, 3> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = {size, CV_32F, planes.values.data() + i * shares.total()};
  cv::split(shares, parts.data());
  return planes;
}

}  // namespace

struct DepthNetwork::Impl {
  std::string path;
  std::unique_ptr<NetworkEngine> engine;
  cv::Size input;
};

DepthNetwork::DepthNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DepthNetwork::~DepthNetwork() = default;

Outcome<std::unique_ptr<DepthNetwork>> DepthNetwork::open(const std::string& path, int cols, int rows,
                                                          std::optional<std::pair<int, int>> input) {
  const auto bytes = readNetwork(path);
  if (!bytes) return failOn(path, bytes.error());
  const auto own = onnxInputOf(*bytes);
  if (!own) return failOn(path, own.error());
  const cv::Size size = inputSize(*own, input, cols, rows);
  if (input && size != cv::Size(input->first, input->second))
    return failOn(print("%s takes pictures of %dx%d", path.c_str(), size.width, size.height), kOneSize);
  auto engine = openNetwork(path, *bytes);
  if (!engine) return std::unexpected(engine.error());
  return std::unique_ptr<DepthNetwork>(new DepthNetwork(std::make_unique<Impl>(Impl{path, std::move(*engine), size})));
}

Outcome<void> DepthNetwork::give(RawPicture picture) {
  auto out = impl_->engine->run(planesOf(picture, impl_->input));
  if (!out) return std::unexpected(out.error());
  if (out->values.empty()) return failOn(impl_->path, kNotDepth);
  const cv::Mat map(out->rows, out->cols, CV_32F, out->values.data());
  cv::Mat shaped;
  cv::resize(map, shaped, outcomeSize(map.size(), picture.cols, picture.rows));
  DepthEstimate answer{shaped.cols, shaped.rows, {shaped.begin<float>(), shaped.end<float>()}};
  std::ranges::replace_if(answer.values, [](float value) { return !std::isfinite(value); }, 0.0F);
  answers_.push_back(std::move(answer));
  return {};
}

Outcome<std::optional<DepthEstimate>> DepthNetwork::take() {
  if (answers_.empty()) return std::nullopt;
  std::optional<DepthEstimate> answer(std::move(answers_.front()));
  answers_.pop_front();
  return answer;
}

}  // namespace relievo

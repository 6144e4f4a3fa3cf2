// SPDX-License-Identifier: Apache-2.0
// Networks of one convolution that the test writes itself, byte by byte, after onnx.proto.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "app/estimate/depth_network.h"
#include "app/estimate/onnx_input.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string varint(std::uint64_t n) {
  std::string bytes;
  for (; n >= 0x80; n >>= 7U) bytes += static_cast<char>(n % 0x80 + 0x80);
  return bytes + static_cast<char>(n);
}
std::string number(int field, std::uint64_t n) {
  return varint(static_cast<std::uint64_t>(field) << 3U) + varint(n);
}
std::string message(int field, const std::string& bytes) {
  return varint(static_cast<std::uint64_t>(field) << 3U | 2U) + varint(bytes.size()) + bytes;
}
// A ValueInfoProto of floats; a length of 0 has a name instead.
std::string value(const std::string& name, const std::vector<int>& lengths) {
  std::string shape;
  for (const int length : lengths) {
    shape += message(1, length > 0 ? number(1, static_cast<std::uint64_t>(length)) : message(2, "any"));
  }
  return message(1, name) + message(2, message(1, number(1, 1) + message(2, shape)));
}
// y = sum of the three parts of x, each times its weight; `outputs` times over.
std::string network(const std::vector<int>& input, const std::vector<float>& weights, int outputs = 1,
                    const std::string& operation = "Conv") {
  std::string raw(4 * weights.size(), '\0');
  std::memcpy(raw.data(), weights.data(), raw.size());
  std::string all;
  for (int i = 0; i < outputs; ++i) all += raw;
  const std::string tensor = number(1, static_cast<std::uint64_t>(outputs)) + number(1, 3) + number(1, 1) +
                             number(1, 1) + number(2, 1) + message(8, "w") + message(9, all);
  const std::string kernel = message(1, "kernel_shape") + number(8, 1) + number(8, 1) + number(20, 7);
  const std::string node = message(1, "x") + message(1, "w") + message(2, "y") + message(3, "only") +
                           message(4, operation) + message(5, kernel);
  const std::string graph = message(1, node) + message(2, "graph") + message(5, tensor) +
                            message(11, value("x", input)) + message(11, value("w", {outputs, 3, 1, 1})) +
                            message(12, value("y", {input[0], outputs, input[2], input[3]}));
  return number(1, 7) + message(7, graph) + message(8, message(1, "") + number(2, 11));
}

Result<OnnxInput> inputOf(const std::string& model) {
  return onnxInputOf({reinterpret_cast<const std::uint8_t*>(model.data()), model.size()});
}

TEST(OnnxInput, TellsTheSizeThatTheNetworkTakes) {
  const auto fixed = inputOf(network({1, 3, 256, 384}, {1, 1, 1}));
  ASSERT_TRUE(fixed.has_value());
  EXPECT_EQ(fixed->cols, 384);
  EXPECT_EQ(fixed->rows, 256);
  const auto any = inputOf(network({1, 3, 0, 0}, {1, 1, 1}));
  ASSERT_TRUE(any.has_value());
  EXPECT_EQ(any->cols, 0);
  EXPECT_EQ(any->rows, 0);
}

TEST(OnnxInput, RefusesWhatIsNoNetworkOfPictures) {
  EXPECT_EQ(inputOf("").error().code, ErrorCode::Corrupt);
  EXPECT_EQ(inputOf("\x89PNG\r\n").error().code, ErrorCode::Corrupt);
  EXPECT_EQ(inputOf(network({1, 4, 8, 8}, {1, 1, 1})).error().code, ErrorCode::Unsupported);
  EXPECT_TRUE(inputOf(network({1, 3, 4096, 4096}, {1, 1, 1})).has_value());
  EXPECT_FALSE(inputOf(network({1, 3, 4096, 4097}, {1, 1, 1})).has_value()) << "it would take gigabytes";
  const std::string whole = network({1, 3, 8, 8}, {1, 1, 1});
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    static_cast<void>(inputOf(whole.substr(0, cut)));  // reads nothing beyond its end
    std::string broken = whole;
    broken[cut] = static_cast<char>(0xff);
    static_cast<void>(inputOf(broken));
  }
}

class Network : public testing::Test {
 protected:
  test::TemporaryFolder folder_;

  [[nodiscard]] std::string written(const std::string& model) const {
    const std::string path = folder_ / "model.onnx";
    std::ofstream(path, std::ios::binary) << model;
    return path;
  }
  // The left half is red, the right half gray.
  static RawPicture picture(int cols, int rows) {
    RawPicture picture(cols, rows);
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const bool left = static_cast<int>(i) % cols < cols / 2;
      const std::array<std::uint8_t, 3> red{255, 0, 0}, gray{51, 51, 51};
      std::ranges::copy(left ? red : gray, picture.pixel(i));
    }
    return picture;
  }
  [[nodiscard]] DepthEstimate answer(const std::string& model, int cols, int rows,
                                     std::optional<std::pair<int, int>> size = std::nullopt) const {
    auto network = DepthNetwork::open(written(model), cols, rows, size);
    EXPECT_TRUE(network.has_value()) << network.error().thing << network.error().error.message;
    EXPECT_TRUE((*network)->give(picture(cols, rows)).has_value());
    auto answer = (*network)->take();
    EXPECT_TRUE(answer.has_value() && *answer);
    EXPECT_FALSE((*network)->take().value());
    return **answer;
  }
};

// The weights undo the deviations, so that the answer is R + 2 G + 4 B less its means.
TEST_F(Network, SeesRedGreenBlueByImageNetsMeans) {
  const std::string model = network({1, 3, 32, 64}, {1 * 0.229F, 2 * 0.224F, 4 * 0.225F});
  const DepthEstimate depth = answer(model, 64, 32);
  ASSERT_EQ(depth.cols, 64);
  ASSERT_EQ(depth.rows, 32);
  const float mean = 0.485F + 2 * 0.456F + 4 * 0.406F;
  EXPECT_NEAR(depth.values[depth.at(5, 9)], 1 - mean, 1e-4);
  EXPECT_NEAR(depth.values[depth.at(60, 20)], 7 * 0.2F - mean, 1e-4);
}

TEST_F(Network, AnswersInThePicturesShape) {
  const DepthEstimate square = answer(network({1, 3, 32, 32}, {1, 1, 1}), 128, 64);
  EXPECT_EQ(square.cols, 64);
  EXPECT_EQ(square.rows, 32);
  EXPECT_GT(square.values[square.at(20, 16)], square.values[square.at(44, 16)]) << "red is brighter than the gray";
  const DepthEstimate any = answer(network({1, 3, 0, 0}, {1, 1, 1}), 1036, 588);
  EXPECT_EQ(any.cols, 518);
  EXPECT_EQ(any.rows, 294);
  const DepthEstimate wished = answer(network({1, 3, 0, 0}, {1, 1, 1}), 1036, 588, std::pair(280, 154));
  EXPECT_EQ(wished.cols, 280);
  EXPECT_EQ(wished.rows, 159) << "154 rows of the network, 280 columns in the picture's shape";
}

TEST_F(Network, RefusesASizeThatANetworkOfAnotherDoesNotTake) {
  const auto failure = [&](std::pair<int, int> wished, const std::vector<int>& input) {
    const auto opened = DepthNetwork::open(written(network(input, {1, 1, 1})), 128, 64, wished);
    return opened ? "none" : opened.error().thing + ": " + opened.error().error.message;
  };
  EXPECT_THAT(failure({280, 154}, {1, 3, 32, 64}), HasSubstr("takes pictures of 64x32: give that as --depth-size"));
  EXPECT_THAT(failure({280, 32}, {1, 3, 0, 64}), HasSubstr("takes pictures of 64x32: ")) << "its columns are given";
  EXPECT_EQ(failure({64, 154}, {1, 3, 0, 64}), "none");
  EXPECT_EQ(failure({64, 32}, {1, 3, 32, 64}), "none");
}

TEST_F(Network, RefusesInOneLine) {
  const auto failure = [&](const std::string& model) {
    const auto network = DepthNetwork::open(written(model), 64, 32, std::nullopt);
    return network ? "none" : network.error().thing + ": " + network.error().error.message;
  };
  EXPECT_THAT(failure("nothing"), HasSubstr("this is not an ONNX model"));
  EXPECT_THAT(failure(network({1, 3, 8, 8}, {1, 1, 1}, 1, "NoSuchLayer")),
              AllOf(HasSubstr("NoSuchLayer"), HasSubstr("cannot run this network")));
  EXPECT_THAT(failure(network({2, 3, 8, 8}, {1, 1, 1})), HasSubstr("must take one picture"));
  auto two = DepthNetwork::open(written(network({1, 3, 32, 64}, {1, 1, 1}, 2)), 64, 32, std::nullopt);
  ASSERT_TRUE(two.has_value());
  EXPECT_STREQ((*two)->give(picture(64, 32)).error().error.message, "the network must give depth in one channel");
  EXPECT_EQ(DepthNetwork::open(folder_ / "none.onnx", 64, 32, std::nullopt).error().error.code, ErrorCode::NotFound);
}

}  // namespace
}  // namespace relievo

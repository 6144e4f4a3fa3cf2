// SPDX-License-Identifier: Apache-2.0
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <string_view>

#include "app/estimate/network_engine.h"

namespace relievo {
namespace {

constexpr Error kNotRun{ErrorCode::Unsupported, 0,
                        "OpenCV " CV_VERSION " cannot run this network; give a command that runs it instead"};

// The layer at which OpenCV failed, if it names it ("Node [Clip@ai.onnx]"); else OpenCV's message.
std::string wordsOf(const cv::Exception& e) {
  constexpr std::string_view kNode = "Node [";
  const std::string words = e.err.empty() ? std::string(e.what()) : e.err;
  const auto node = words.find(kNode);
  if (node == std::string::npos) return inOneLine(words);
  const auto name = node + kNode.size();
  return "layer " + words.substr(name, words.find_first_of("@]", name) - name);
}

std::unexpected<Failure> notRun(const std::string& path, const cv::Exception& e) {
  return failOn(path + ": " + wordsOf(e), kNotRun);
}

class OpenCvNetwork final : public NetworkEngine {
 public:
  OpenCvNetwork(std::string path, const cv::dnn::Net& net) : path_(std::move(path)), net_(net) {}

  Outcome<NetworkPlanes> run(NetworkPlanes input) override {
    try {
      const int planes = static_cast<int>(input.values.size()) / (input.cols * input.rows);
      net_.setInput(cv::Mat({1, planes, input.rows, input.cols}, CV_32F, input.values.data()));
      const cv::Mat out = net_.forward();
      if (out.type() != CV_32F) return NetworkPlanes{};
      const std::vector<std::int64_t> shape(out.size.p, out.size.p + out.dims);
      return planesOfOutput(shape, out.ptr<float>());
    } catch (const cv::Exception& e) {
      return notRun(path_, e);
    }
  }

 private:
  std::string path_;
  cv::dnn::Net net_;
};

}  // namespace

Outcome<std::unique_ptr<NetworkEngine>> openNetwork(const std::string& path, std::span<const std::uint8_t> model) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // the exception has the same message
  try {
    return std::make_unique<OpenCvNetwork>(
        path, cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(model.data()), model.size()));
  } catch (const cv::Exception& e) {
    return notRun(path, e);
  }
}

}  // namespace relievo

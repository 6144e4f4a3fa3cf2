// SPDX-License-Identifier: Apache-2.0
#include <onnxruntime_cxx_api.h>

#include <array>
#include <iostream>

#include "app/estimate/network_engine.h"

namespace relievo {
namespace {

constexpr Error kNotRun{ErrorCode::Unsupported, 0,
                        "ONNX Runtime cannot run this network; give a command that runs it instead"};

std::unexpected<Failure> notRun(const std::string& path, const Ort::Exception& e) {
  return failOn(path + ": " + inOneLine(e.what()), kNotRun);
}

// Debian's ONNX Runtime 1.21 registers ONNX's operations twice when its first session begins, and complains of each on
// std::cerr, which this program does not use.
class QuietCerr {
 public:
  QuietCerr() = default;
  ~QuietCerr() { std::cerr.rdbuf(said_); }
  QuietCerr(const QuietCerr&) = delete;
  QuietCerr& operator=(const QuietCerr&) = delete;

 private:
  std::streambuf* said_ = std::cerr.rdbuf(nullptr);
};

class OnnxRuntimeNetwork final : public NetworkEngine {
 public:
  // Throws Ort::Exception.
  OnnxRuntimeNetwork(std::string path, std::span<const std::uint8_t> model)
      : path_(std::move(path)), session_(environment_, model.data(), model.size(), Ort::SessionOptions()) {
    Ort::AllocatorWithDefaultOptions memory;
    input_ = session_.GetInputNameAllocated(0, memory).get();
    output_ = session_.GetOutputNameAllocated(0, memory).get();
  }

  Outcome<NetworkPlanes> run(NetworkPlanes input) override {
    try {
      const std::array<std::int64_t, 4> shape{
          1, static_cast<std::int64_t>(input.values.size()) / (input.cols * input.rows), input.rows, input.cols};
      const Ort::Value value =
          Ort::Value::CreateTensor<float>(Ort::MemoryInfo::CreateCpu(OrtDeviceAllocator, OrtMemTypeCPU),
                                          input.values.data(), input.values.size(), shape.data(), shape.size());
      const std::array<const char*, 1> from{input_.c_str()}, to{output_.c_str()};
      const auto outs = session_.Run(Ort::RunOptions(), from.data(), &value, 1, to.data(), 1);
      const auto about = outs.front().GetTensorTypeAndShapeInfo();
      if (about.GetElementType() != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT) return NetworkPlanes{};
      return planesOfOutput(about.GetShape(), outs.front().GetTensorData<float>());
    } catch (const Ort::Exception& e) {
      return notRun(path_, e);
    }
  }

 private:
  std::string path_;
  Ort::Env environment_{ORT_LOGGING_LEVEL_FATAL, "relievo"};  // the exception has the same message
  Ort::Session session_;
  std::string input_, output_;
};

}  // namespace

Outcome<std::unique_ptr<NetworkEngine>> openNetwork(const std::string& path, std::span<const std::uint8_t> model) {
  const QuietCerr quiet;
  try {
    return std::make_unique<OnnxRuntimeNetwork>(path, model);
  } catch (const Ort::Exception& e) {
    return notRun(path, e);
  }
}

}  // namespace relievo

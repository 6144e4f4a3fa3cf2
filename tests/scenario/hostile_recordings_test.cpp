// SPDX-License-Identifier: Apache-2.0
// Damaged recordings and files beside them, given to the programs that users start: each plays, is described or packed,
// or is refused by an error with words; none crashes, hangs or exhausts the memory. RELIEVO_DAMAGED=100 in the
// environment tries a thousand, a hundred of each kind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iterator>
#include <random>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/damage.h"
#include "tests/support/film/recording/bag_writer.h"
#include "tests/support/film/recording/heic_writer.h"
#include "tests/support/film/recording/kinect_mkv.h"
#include "tests/support/film/recording/oni_writer.h"
#include "tests/support/film/recording/ros2_bags.h"
#include "tests/support/film/recording/ros_messages.h"
#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

using test::contentOf;
using test::write;

int filesOfAKind() {
  const char* const wanted = std::getenv("RELIEVO_DAMAGED");
  return wanted != nullptr ? std::atoi(wanted) : 8;
}
constexpr rlim_t kMostCpuS = 10;
constexpr long kMostKb = 512 * 1024;
constexpr int kCols = 32, kRows = 24;

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}
// Metres, or pixels of disparity.
float valueAt(int c, int r) {
  return 1 + 0.05F * static_cast<float>(c + r);
}
std::string values() {
  std::string bytes;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) bytes += raw(valueAt(c, r));
  }
  return bytes;
}
std::string pfm() {
  return "Pf\n32 24\n-1\n" + values();
}
std::string npy() {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (24, 32), }";
  header.resize(117, ' ');
  return std::string("\x93NUMPY\x01\0\x76\0", 10) + header + "\n" + values();
}
// OpenEXR 2: scan lines without compression, one channel Z of floats.
std::string exr() {
  const auto attribute = [](const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + raw(static_cast<std::int32_t>(value.size())) + value;
  };
  const auto box = raw(0) + raw(0) + raw(kCols - 1) + raw(kRows - 1);
  std::string file = raw(20000630) + raw(2) +
                     attribute("channels", "chlist",
                               std::string("Z\0", 2) + raw(2) + raw(0) + raw(1) + raw(1) + std::string(1, '\0')) +
                     attribute("compression", "compression", std::string(1, '\0')) +
                     attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box) +
                     attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                     attribute("pixelAspectRatio", "float", raw(1.0F)) +
                     attribute("screenWindowCenter", "v2f", raw(0.0F) + raw(0.0F)) +
                     attribute("screenWindowWidth", "float", raw(1.0F)) + std::string(1, '\0');
  const std::size_t line = 4 * kCols, begin = file.size() + 8 * kRows;
  const std::string samples = values();
  for (std::size_t r = 0; r < kRows; ++r) file += raw(static_cast<std::uint64_t>(begin + r * (8 + line)));
  for (std::size_t r = 0; r < kRows; ++r) {
    file += raw(static_cast<std::int32_t>(r)) + raw(static_cast<std::int32_t>(line)) + samples.substr(r * line, line);
  }
  return file;
}

std::string bag() {
  std::string color, depth;
  for (int i = 0; i < kCols * kRows; ++i) {
    color.append(3, static_cast<char>(i));
    depth += raw(static_cast<std::uint16_t>(1000 + i));
  }
  test::BagWriter writer("lz4");
  const auto colors = writer.connect("/camera/color/image_raw", "sensor_msgs/Image"),
             depths = writer.connect("/camera/depth/image_raw", "sensor_msgs/Image");
  for (int k = 0; k < 4; ++k) {
    const std::int64_t ns = 1'000'000'000 + k * 33'000'000LL;
    const test::BagImage picture{
        .stamp_ns = ns, .cols = kCols, .rows = kRows, .step = 3 * kCols, .encoding = "rgb8", .data = color};
    test::BagImage distances = picture;
    distances.step = 2 * kCols;
    distances.encoding = "16UC1";
    distances.data = depth;
    writer.write(colors, ns, test::bagImage(picture));
    writer.write(depths, ns, test::bagImage(distances));
  }
  writer.endChunk();
  return writer.finish();
}

std::string oni() {
  std::vector<std::uint16_t> depth;
  for (int i = 0; i < kCols * kRows; ++i) depth.push_back(static_cast<std::uint16_t>(1000 + i));
  test::OniWriter writer;
  const auto color =
      writer.add({.kind = test::kOniColor, .codec = "NONE", .cols = kCols, .rows = kRows, .format = test::kOniRgb});
  const auto distances = writer.add({.cols = kCols, .rows = kRows});
  for (std::uint64_t k = 0; k < 4; ++k) {
    writer.write(color, k * 33'000, std::string(3 * depth.size(), static_cast<char>(50 * k)));
    writer.write(distances, k * 33'000, test::oni16zTable(depth));
  }
  return writer.finish();
}

std::string heic() {
  static const test::HevcPicture picture = test::hevcPicture(
      [](int k, int c, int r, int) { return k == 0 ? static_cast<std::uint32_t>(40 + c + r / 2) : 128u; });
  return test::heicFile(
      picture, picture,
      {.xmp = "<apdi:FloatMinValue>0.4</apdi:FloatMinValue><apdi:FloatMaxValue>2</apdi:FloatMaxValue>"});
}

std::string picture(const std::string& name, const std::string& codec, const std::string& format) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / name, {{.codec = codec, .pix_fmt = format, .width = kCols, .height = kRows, .frames = 1}});
  return contentOf(folder / name);
}
std::string segment(char marker, const std::string& content) {
  const auto bytes = content.size() + 2;
  return std::string("\xff") + marker + static_cast<char>(bytes >> 8) + static_cast<char>(bytes) + content;
}
// Dynamic Depth: the depth map follows the picture.
std::string jpeg() {
  const std::string color = picture("a.jpg", "mjpeg", "yuvj420p"), map = picture("a.png", "png", "gray");
  const std::string xmp =
      "<rdf:Description DepthMap:Format=\"RangeInverse\" DepthMap:Near=\"0.5\" "
      "DepthMap:Far=\"4\"/><Container:Directory>"
      "<rdf:li Item:DataURI=\"primary\"/><rdf:li Item:DataURI=\"depthmap\" Item:Length=\"" +
      std::to_string(map.size()) + "\"/></Container:Directory>";
  return color.substr(0, 2) + segment('\xe1', std::string("http://ns.adobe.com/xap/1.0/\0", 29) + xmp) +
         color.substr(2) + map;
}
// Two pictures of type "disparity".
std::string mpo() {
  const std::string one = picture("a.jpg", "mjpeg", "yuvj420p");
  const auto size = static_cast<std::uint32_t>(one.size());
  const std::uint32_t index = 8 + 2 + 12 + 4 + 32, second = size + 4 + 4 + index - 10;
  const std::string entries = raw(0x020002) + raw(size + 8 + index) + raw(0) + raw(0) +  //
                              raw(0x020002) + raw(size) + raw(second) + raw(0);
  const std::string content = std::string("MPF\0II\x2a\0", 8) + raw(8) + raw(std::uint16_t{1}) +
                              raw(std::uint16_t{0xb002}) + raw(std::uint16_t{7}) + raw(32) + raw(26) + raw(0) + entries;
  return one.substr(0, 2) + segment('\xe2', content) + one.substr(2) + one;
}

std::string calibration() {
  const auto camera = [](const char* location, const char* lens) {
    return R"({"Intrinsics":{"ModelParameterCount":14,"ModelParameters":[)" + std::string(lens) +
           R"(,0,0,0,0,0,0,0,0,0,0],"ModelType":"CALIBRATION_LensDistortionModelBrownConrady"},)" +
           R"("Location":"CALIBRATION_CameraLocation)" + location +
           R"(","MetricRadius":1.74,"Rt":{"Rotation":[1,0,0,0,1,0,0,0,1],"Translation":[0,0,0]},)" +
           R"("SensorHeight":1024,"SensorWidth":1024})";
  };
  return R"({"CalibrationInformation":{"Cameras":[)" + camera("D0", "0.5,0.45,0.5,0.5") + "," +
         camera("PV0", "0.5,0.5,0.8,1.06") + "]}}";
}
std::string kinect(const std::string& calibration_json) {
  constexpr int kDepthCols = 320, kDepthRows = 288, kColorCols = 1280, kColorRows = 720;
  std::string depth;
  for (int i = 0; i < kDepthCols * kDepthRows; ++i) depth += std::string("\x04", 1) + static_cast<char>(i / kDepthCols);
  const std::string color(kColorCols * kColorRows * 3 / 2, '\x80');
  return test::kinectMkv(
      {{.name = "COLOR",
        .fourcc = "NV12",
        .cols = kColorCols,
        .rows = kColorRows,
        .bits = 12,
        .pictures = {color, color}},
       {.name = "DEPTH", .fourcc = "b16g", .cols = kDepthCols, .rows = kDepthRows, .pictures = {depth, depth}}},
      calibration_json);
}

// One kind: what is damaged, and how a recording is made of it in a folder, whose arguments on the command line are
// returned.
struct Kind {
  const char* name;
  std::string (*bytes)();
  std::vector<std::string> (*put)(const std::string& folder, const std::string& bytes);
};
void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}
template <const char* kEnding>
std::vector<std::string> alone(const std::string& folder, const std::string& bytes) {
  write(folder + "/x" + kEnding, bytes);
  return {folder + "/x" + kEnding};
}
constexpr char kBag[] = ".bag", kMcap[] = ".mcap", kDb3[] = ".db3", kOni[] = ".oni", kExr[] = ".exr", kPfm[] = ".pfm",
               kNpy[] = ".npy", kHeic[] = ".heic", kJpg[] = ".jpg", kMpo[] = ".mpo";

std::vector<std::string> besideColor(const std::string& folder, const std::string& depth) {
  static const std::string color = picture("a.png", "png", "rgb24");
  write(folder + "/im0.png", color);
  return {folder + "/im0.png", folder + "/" + depth};
}
const Kind kKinds[] = {
    {"bag", bag, alone<kBag>},
    {"mcap", [] { return test::mcapOf(test::depthOnRos2(), {.compression = "zstd"}); }, alone<kMcap>},
    {"db3", [] { return test::db3Of(test::depthOnRos2()); }, alone<kDb3>},
    {"oni", oni, alone<kOni>},
    {"exr", exr, alone<kExr>},
    {"pfm", pfm, alone<kPfm>},
    {"npy", npy, alone<kNpy>},
    {"heic", heic, alone<kHeic>},
    {"jpeg", jpeg, alone<kJpg>},
    {"mpo", mpo, alone<kMpo>},
    {"calibration_json", calibration,
     [](const std::string& folder, const std::string& bytes) {
       write(folder + "/x.mkv", kinect(bytes));
       return std::vector{folder + "/x.mkv"};
     }},
    {"associations_txt",
     [] {
       return std::string(
           "1305031102.175304 rgb/1305031102.175304.png 1305031102.160407 depth/1305031102.160407.png\n"
           "1305031102.211214 rgb/1305031102.211214.png 1305031102.226738 depth/1305031102.226738.png\n");
     },
     [](const std::string& folder, const std::string& bytes) {
       static const std::string color = picture("a.png", "png", "rgb24"), depth = picture("a.png", "png", "gray16be");
       for (const char* sub : {"/rgb", "/depth"}) std::filesystem::create_directories(folder + sub);
       for (const char* name : {"175304", "211214"}) write(folder + "/rgb/1305031102." + name + ".png", color);
       for (const char* name : {"160407", "226738"}) write(folder + "/depth/1305031102." + name + ".png", depth);
       write(folder + "/associations.txt", bytes);
       return std::vector{folder};
     }},
    {"calib_txt",
     [] { return std::string("cam0=[400 0 16; 0 400 12; 0 0 1]\ndoffs=3\nbaseline=120\nwidth=32\nvmin=1\nvmax=5\n"); },
     [](const std::string& folder, const std::string& bytes) {
       write(folder + "/calib.txt", bytes);
       write(folder + "/disp0.pfm", pfm());
       return besideColor(folder, "disp0.pfm");
     }},
};

// Exit status of a program, its peak memory, and what it said.
struct End {
  int status = 0;
  rusage used{};
  std::string words;
};
End run(const std::vector<std::string>& words, const std::string& folder) {
  const std::string said = folder + "/said.txt";
  std::vector<std::string> all = words;
  all[0] = std::string(RELIEVO_BIN_DIR) + "/" + words[0];
  std::vector<char*> arguments;
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit cpu{.rlim_cur = kMostCpuS, .rlim_max = kMostCpuS};
    ::setrlimit(RLIMIT_CPU, &cpu);
    ::alarm(100);  // ends a process that hangs
    const int out = ::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), in = ::open("/dev/null", O_RDONLY);
    ::dup2(in, 0), ::dup2(out, 1), ::dup2(out, 2);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  End end;
  ::wait4(child, &end.status, 0, &end.used);
  end.words = contentOf(said);
  return end;
}

enum class Program { Probe, Play, Author };
std::vector<std::string> commandFor(Program program, const std::vector<std::string>& source,
                                    const std::string& folder) {
  std::vector<std::string> words;
  if (program == Program::Author) {
    words = {"relievo-author", "--color", source[0], "-o", folder + "/out.mkv"};
  } else if (program == Program::Play) {
    words = {"relievo",  "play", source[0], "--display", "mock",       "--haptic", "none",
             "--remote", "none", "--audio", "none",      "--duration", "0.1"};
  } else {
    words = {"relievo", "probe", source[0]};
  }
  if (source.size() > 1) words.insert(words.end(), {"--depth", source[1]});
  return words;
}

class HostileRecordings : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, HostileRecordings, testing::ValuesIn(kKinds),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(HostileRecordings, AreReadOrRefusedWithWords) {
  const Kind& kind = GetParam();
  const std::string whole = kind.bytes();
  const test::TemporaryFolder folder;
  const int files = filesOfAKind();
  int read = 0;
  // The first file is whole.
  for (int i = 0; i <= files; ++i) {
    std::mt19937 random(static_cast<unsigned>(i));
    const std::string place = folder / std::to_string(i);
    std::filesystem::create_directories(place);
    const auto source = kind.put(place, i == 0 ? whole : test::damaged(whole, random));
    for (const Program program : {Program::Probe, Program::Play, Program::Author}) {
      // Every file is probed; the slower programs take turns.
      if (i > 0 && program == Program::Play && i % 4 != 1) continue;
      if (i > 0 && program == Program::Author && i % 4 != 3) continue;
      const End end = run(commandFor(program, source, place), place);
      SCOPED_TRACE(testing::Message() << "file " << i << ", " << commandFor(program, source, place)[0] << ": "
                                      << end.words);
      ASSERT_TRUE(WIFEXITED(end.status)) << "ended by signal " << WTERMSIG(end.status);
      const int code = WEXITSTATUS(end.status);
      ASSERT_TRUE(code == 0 || code == 1) << "ended with code " << code;
      ASSERT_TRUE(i > 0 || code == 0 || program != Program::Probe) << "the whole one is refused";
      ASSERT_TRUE(code == 0 || !end.words.empty());
      if (!kMemorySanitizer) {
        ASSERT_LT(end.used.ru_maxrss, kMostKb);
      }
      if (program == Program::Probe && i > 0) read += code == 0 ? 1 : 0;
    }
    std::filesystem::remove_all(place);
  }
  if (files >= 100) {
    EXPECT_GT(read, 0) << "so much damage tests nothing";
  }
}

}  // namespace
}  // namespace relievo

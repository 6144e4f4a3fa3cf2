// SPDX-License-Identifier: Apache-2.0
// Options shared by the programs. Errors in a word are thrown while CLI11 parses, as CLI11's own are.
#include "app/cli/options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include "platform/text/lower_case.h"
#include "platform/text/number_in.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr double kLongestMm = 1e5;  // limit for a side of the volume
constexpr const char* kNoVolume = "a box is WIDTHxHEIGHTxDEPTH in mm, such as 160x90x40";

// Of --calibration, and below of --material.
const std::vector<std::string>& calibrationWords() {
  static const std::vector<std::string> words{"law",      "polarity", "range",   "bits",   "codes",   "invalid",
                                              "unit",     "near",     "far",     "linear", "inverse", "near-high",
                                              "near-low", "full",     "limited", "none"};
  return words;
}

const std::vector<std::string>& materialWords() {
  static const std::vector<std::string> words{"stiffness", "friction", "texture"};
  return words;
}

// " (law?)": the known word that the first unknown word of KEY=VALUE,.. resembles; empty if there is none.
std::string guessed(const std::string& text, std::span<const std::string> words) {
  const std::string small = lowerCase(text);
  for (std::size_t begin = 0; begin < small.size();) {
    const std::size_t end = std::min(small.find_first_of(",=", begin), small.size());
    const std::string word = small.substr(begin, end - begin);
    const std::string near = nearestWord(word, words);
    if (word.size() > 2 && !near.empty() && near != word) return " (" + near + "?)";
    begin = end + 1;
  }
  return "";
}

std::string readFile(const std::string& thing, const std::string& path, const char* otherwise) {
  auto text = readWholeFile(path, FileSize::Settings, otherwise);
  if (!text) throw WordFailure({thing, text.error()});
  return std::move(*text);
}

// A missing or bad file is a failure at run time, not a usage error.
CalibrationSettings readCalibrationFile(const std::string& thing, const std::string& path) {
  auto settings = parseCalibration(readFile(thing, path, "cannot be read; give the path of a file, or KEY=VALUE,.."));
  if (!settings) throw WordFailure({thing, {ErrorCode::Corrupt, 0, settings.error().message}});
  if (settings->empty()) throw WordFailure({thing, {ErrorCode::Corrupt, 0, "is empty; write KEY=VALUE in each line"}});
  return std::move(*settings);
}

void readCalibration(const std::string& word, SourceOptions& source) {
  const std::string thing = "--calibration " + word;
  if (word.find('=') == std::string::npos) {
    source.side_file = readCalibrationFile(thing, word);
    source.named_files.push_back(word);
    return;
  }
  const auto settings = parseCalibration(lowerCase(word));
  if (!settings) throw WordFailure({thing + guessed(word, calibrationWords()), settings.error()});
  for (const auto& [key, value] : *settings) source.command_line[key] = value;  // overrides earlier ones
}

// A failure names the part of the word that is wrong.
Material readMaterial(const std::string& word) {
  const std::string small = lowerCase(word);
  const auto material = parseMaterial(small);
  if (material) return *material;
  std::istringstream items(small);
  for (std::string item; std::getline(items, item, ',');) {
    const auto one = parseMaterial(item.empty() ? "," : item);
    if (!one) throw WordFailure({"--material " + item + guessed(item, materialWords()), one.error()});
  }
  throw WordFailure({"--material " + word, material.error()});
}

// True for FILE or SECONDS=FILE,..; the parts of a material have names.
bool namesMaps(const std::string& word) {
  return word.find('=') == std::string::npos || std::string_view("0123456789.").contains(word.front());
}

Registration readRegistration(const std::string& path) {
  const std::string thing = "--registration " + path;
  auto registration = parseRegistration(readFile(thing, path, "cannot be read; give the path of a file"));
  if (!registration) throw WordFailure({thing, {ErrorCode::Corrupt, 0, registration.error().message}});
  return *registration;
}

}  // namespace

std::string meant(std::string_view wanted, std::span<const std::string> words) {
  const std::string near = nearestWord(wanted, words);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

bool parseSizes(std::string_view text, std::span<double> sizes) noexcept {
  return readNumbers(text, 'x', sizes) && std::ranges::all_of(sizes, [](double size) { return size > 0; });
}

namespace {

// The first word of each line.
std::vector<std::string> kindNames() {
  std::istringstream lines(kindsText());
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) names.push_back(line.substr(0, line.find(' ')));
  return names;
}

void addKindOption(CLI::App& app, SourceOptions& source) {
  app.add_option_function<std::string>(
         "--as",
         [&source](const std::string& word) {
           if (word == "help") throw KindsAsked();
           source.as = findKind(word);
           if (source.as == nullptr) {
             throw CLI::ValidationError("--as " + word, "unknown kind" + meant(word, kindNames()) + "; see --as help");
           }
         },
         "Kind of recording, where it is not recognised: tum, kitti, sun, record3d, ..; --as help lists them\n"
         "Sets packing, code and calibration at once; --packing, --depth-code and --calibration override it")
      ->type_name("KIND");
}

// The words of --depth-code.
std::vector<std::pair<std::string, std::optional<DepthCode>>> depthCodes() {
  std::vector<std::pair<std::string, std::optional<DepthCode>>> words{{"auto", std::nullopt}};
  for (const DepthCode code : kDepthCodes) words.emplace_back(name(code), code);
  return words;
}

}  // namespace

void addDepthOptions(CLI::App& app, SourceOptions& source) {
  addKindOption(app, source);
  addChoice(
      app, "--packing", source.packing,
      {{"auto", Packing::Auto},
       {"tracks", Packing::Tracks},
       {"sbs", Packing::SideBySide},
       {"tb", Packing::TopBottom},
       {"sbs-depth-first", Packing::SideBySideDepthFirst},
       {"tb-depth-first", Packing::TopBottomDepthFirst},
       {"alpha", Packing::Alpha},
       {"depth-alone", Packing::DepthAlone},
       {"stereo-sbs", Packing::StereoSideBySide},
       {"stereo-tb", Packing::StereoTopBottom},
       {"stereo-tracks", Packing::StereoTracks}},
      "Where the film stores its depth\n"
      "auto: two tracks, a DEPTH_PACKING tag, or a picture whose halves differ clearly; tracks: two video tracks, or "
      "--depth;\n"
      "sbs: one picture, colour left, depth right; tb: colour on top, depth below; ..-depth-first: the other way "
      "round; alpha: in its alpha channel;\ndepth-alone: the picture is depth, without colour;\n"
      "stereo-sbs, stereo-tb, stereo-tracks: two views without depth; the left eye's is on the left, on top, or in the "
      "first of two tracks; each eye sees its own view");
  addChoice(app, "--depth-code", source.depth_code, depthCodes(),
            "How depth is coded\n"
            "auto: hue if half of the picture is pure colour, else luma; luma: as brightness; hue: from red (near) "
            "through yellow, green, blue and magenta to almost red (far), RealSense's and Record3D's hues too;\n"
            "the other words name colour maps; spectral: from blue to red, ylgnbu: from yellow to blue, kinect: black "
            "(no depth), blue, cyan, white");
  app.add_option_function<std::vector<std::string>>(
         "--calibration",
         [&source](const std::vector<std::string>& given) {
           for (const std::string& text : given) readCalibration(text, source);
         },
         "How to interpret depth codes; overrides the film's tags. Or a FILE with one KEY=VALUE per line\n"
         "law=linear|inverse: codes are proportional to distance or to 1/distance;\n"
         "polarity=near-high|near-low, range=full|limited, bits=8..16,\n"
         "codes=LOW-HIGH: the range of codes in use, if not all;\n"
         "invalid=CODE+CODE+LOW-HIGH..|none: codes that mean no reading;\n"
         "unit=MM: a code is a distance, counted in steps of MM mm;\n"
         "near=MM, far=MM: with unit or the inverse law, the distances at the front and at the back of the box")
      ->allow_extra_args(false)
      ->type_name("FILE|KEY=VALUE,..");
  app.add_option_function<std::string>(
         "--registration",
         [&source](const std::string& path) {
           source.registration = readRegistration(path);
           source.named_files.push_back(path);
         },
         "TOML file with the lenses and the relative position of the depth and colour cameras;\n"
         "aligns the depth with the colour picture")
      ->type_name("FILE.toml");
}

void addMaterialOption(CLI::App& app, SourceOptions& source) {
  app.add_option_function<std::string>(
         "--material", [&source](const std::string& word) { source.material = readMaterial(word); },
         "What the surface feels like; overrides the film's tags and material track, part by part\n"
         "stiffness=N/MM [0.5, or less where the device is not stable at that];\n"
         "friction=STATIC/DYNAMIC: coefficients [0];\n"
         "texture=AMPLITUDE@WAVELENGTH: ripples, mm [0], such as stiffness=.3,friction=.2/.15,texture=.1@.8")
      ->type_name("KEY=VALUE,..");
}

void addMaterialOption(CLI::App& app, SourceOptions& source, std::string& maps) {
  app.add_option_function<std::vector<std::string>>(
         "--material",
         [&source, &maps](const std::vector<std::string>& given) {
           for (const std::string& word : given) {
             if (namesMaps(word)) maps = word;
             else source.material = readMaterial(word);
           }
         },
         "What the surface feels like: stiffness=N/MM, friction=STATIC/DYNAMIC: coefficients,\n"
         "texture=AMPLITUDE@WAVELENGTH: ripples, mm, such as stiffness=.3,friction=.2/.15,texture=.1@.8. Or at each\n"
         "place: FILE, a picture painted over the film's first one; the paint follows the objects to the first cut;\n"
         "0=FILE,SECONDS=FILE,..: a painting for each shot, from its first picture on, or a film of such pictures. "
         "Red\n"
         "is stiffness, green friction, blue texture; gray is stiffness alone; what is transparent is not painted.\n"
         "With a painting, KEY=VALUE says what full red, green and blue stand for "
         "[stiffness=1,friction=.6/.5,texture=.2@.8]")
      ->allow_extra_args(false)
      ->type_name("FILE|SECONDS=FILE,..|KEY=VALUE,..");
}

void addRateOption(CLI::App& app, SourceOptions& source) {
  app.add_option("--fps", source.frames_per_s, "Frames per second of pictures that have numbers but no times [30]")
      ->type_name("F")
      ->check(between(0.01, 10000.0));
}

void addBoxOption(CLI::App& app, std::optional<DisplayVolume>& volume) {
  app.add_option_function<std::string>(
         "--box",
         [&volume](const std::string& text) {
           std::array<double, 3> mm{};
           if (!parseSizes(text, mm) || *std::max_element(mm.begin(), mm.end()) > kLongestMm) {
             throw WordFailure({"--box " + text, {ErrorCode::InvalidArgument, 0, kNoVolume}});
           }
           volume = DisplayVolume{mm[0], mm[1], mm[2]};
         },
         "Box that the relief fills, mm\n[160 wide, 40 deep, height from the picture's aspect ratio]")
      ->type_name("WxHxD");
}

CLI::Validator between(double low, double high) {
  const auto judge = [low, high](const std::string& word) -> std::string {
    double number = 0;
    const bool is_number = CLI::detail::lexical_cast(word, number);
    if (is_number && number >= low && number <= high) return {};
    std::ostringstream words;
    words << word << (is_number ? " is not between " : " is not a number; give one between ") << low << " and " << high;
    return words.str();
  };
  return {judge, ""};
}

}  // namespace relievo

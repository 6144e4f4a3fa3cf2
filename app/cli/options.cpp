// SPDX-License-Identifier: Apache-2.0
// Options shared by the programs. Errors in a word are thrown while CLI11 parses, as CLI11's own are.
#include "app/cli/options.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>

#include "app/cli/program.h"
#include "platform/log.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr double kLongestMm = 1e5;  // limit for a side of the volume
constexpr const char* kNoVolume = "a box is WIDTHxHEIGHTxDEPTH in mm, such as 160x90x40";

std::string readFile(const std::string& thing, const std::string& path, const char* otherwise) {
  auto text = readWholeFile(path, FileSize::Settings, otherwise);
  if (!text) throw WordFailure({thing, text.error()});
  return std::move(*text);
}

// A missing or bad file is a failure at run time, not a usage error.
CalibrationSettings readCalibrationFile(const std::string& thing, const std::string& path) {
  auto settings = parseCalibration(readFile(thing, path, "cannot be read; give the path of a file, or KEY=VALUE,.."));
  if (!settings) throw WordFailure({thing, {ErrorCode::Corrupt, 0, settings.error().message}});
  return std::move(*settings);
}

void readCalibration(const std::string& word, SourceOptions& source) {
  const std::string thing = "--calibration " + word;
  if (word.find('=') == std::string::npos) {
    source.side_file = readCalibrationFile(thing, word);
    source.named_files.push_back(word);
    return;
  }
  const auto settings = parseCalibration(inSmallLetters(word));
  if (!settings) throw WordFailure({thing, settings.error()});
  for (const auto& [key, value] : *settings) source.command_line[key] = value;  // overrides earlier ones
}

// A failure names the part of the word that is wrong.
Material readMaterial(const std::string& word) {
  const std::string small = inSmallLetters(word);
  const auto material = parseMaterial(small);
  if (material) return *material;
  std::istringstream items(small);
  for (std::string item; std::getline(items, item, ',');) {
    const auto one = parseMaterial(item.empty() ? "," : item);
    if (!one) throw WordFailure({"--material " + item, one.error()});
  }
  throw WordFailure({"--material " + word, material.error()});
}

Registration readRegistration(const std::string& path) {
  const std::string thing = "--registration " + path;
  auto registration = parseRegistration(readFile(thing, path, "cannot be read; give the path of a file"));
  if (!registration) throw WordFailure({thing, {ErrorCode::Corrupt, 0, registration.error().message}});
  return *registration;
}

// "relievo play": the program and the command, if one was given.
std::string commandOf(const CLI::App& program) {
  std::string command = program.get_name();
  for (const CLI::App* given : program.get_subcommands()) command += " " + given->get_name();
  return command;
}

std::vector<std::string> namesOf(const std::vector<CLI::App*>& commands) {
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// The given command, its own command, ..
const CLI::App* innermost(const CLI::App* program) {
  const auto given = program->get_subcommands();
  return given.empty() ? program : innermost(given.back());
}

std::vector<std::string> optionsOf(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options([](const CLI::Option*) { return true; })) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// CLI11 says that an argument "was not expected"; this names what was meant, too.
void tellUnexpected(const CLI::App& program, const std::string& word) {
  const std::string option = word.substr(0, word.find('='));
  log(LogLevel::Error, word.c_str(), "%s%s; see %s --help", word.starts_with('-') ? "no such option" : "one too many",
      meant(option, optionsOf(*innermost(&program))).c_str(), commandOf(program).c_str());
}

void tellWrongUse(CLI::App& program, const CLI::ParseError& error) {
  const auto commands = namesOf(program.get_subcommands([](const CLI::App*) { return true; }));
  const auto words = program.remaining(true);
  const bool known = commands.empty() || !program.get_subcommands().empty();
  if (known && !words.empty() && dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    tellUnexpected(program, words.front());
  } else if (known) {
    log(LogLevel::Error, "usage error", "%s; see %s --help", error.what(), commandOf(program).c_str());
  } else if (!words.empty()) {
    log(LogLevel::Error, words.front().c_str(), "unknown command%s; use one of %s; see %s --help",
        meant(words.front(), commands).c_str(), joined(commands).c_str(), program.get_name().c_str());
  } else {
    log(LogLevel::Error, "usage error", "missing command; use one of %s; see %s --help", joined(commands).c_str(),
        program.get_name().c_str());
  }
}

// Thrown by --as help.
struct KindsAsked final : std::exception {};

// Prints an option as "--packing auto|tracks|sbs|tb     Where the depth is [auto]".
class Help final : public CLI::Formatter {
 public:
  using CLI::Formatter::Formatter;

  std::string make_description(const CLI::App* app) const override {
    const std::string text = app->get_description();
    return text.substr(0, text.find('\n')) + "\n";
  }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    const std::string text = app->get_description();
    const std::size_t end = text.find('\n');
    return CLI::Formatter::make_usage(app, std::move(name)) +
           (end == std::string::npos ? "" : text.substr(end + 1) + "\n");
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::stringstream out;
    const std::string text = command->get_description();
    CLI::detail::format_help(out, command->get_name(), text.substr(0, text.find('\n')), get_column_width());
    return out.str();
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const bool named = option->get_type_size() != 0 && option->get_type_name() != " ";
    const std::string type = named ? option->get_type_name() : "";
    const bool many = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    return (type.empty() ? "" : " " + type) + (many ? " ..." : "") +
           (option->get_required() ? " " + get_label("REQUIRED") : "");
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    std::string text = option->get_description();
    const std::string& usual = option->get_default_str();
    if (!usual.empty() && !option->get_required())
      text.insert(std::min(text.find('\n'), text.size()), " [" + usual + "]");
    return text;
  }
};

void setHelp(CLI::App& app, const std::string& version) {
  app.formatter(std::make_shared<Help>());
  app.set_version_flag("-V,--version", version, "Print the version and exit")->configurable(false);
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) setHelp(*command, version);
}

}  // namespace

std::string meant(std::string_view wanted, std::span<const std::string> words) {
  const std::string near = nearestWord(wanted, words);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

bool parseSizes(std::string_view text, std::span<double> sizes) noexcept {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (double& size : sizes) {
    if (&size != sizes.data()) {
      if (at == end || *at != 'x') return false;
      ++at;
    }
    const auto [next, error] = std::from_chars(at, end, size);
    if (error != std::errc{} || !std::isfinite(size) || size <= 0) return false;
    at = next;
  }
  return at == end;
}

namespace {

void addKindOption(CLI::App& app, SourceOptions& source) {
  app.add_option_function<std::string>(
         "--as",
         [&source](const std::string& word) {
           if (word == "help") throw KindsAsked();
           source.as = findKind(word);
           if (source.as == nullptr) throw CLI::ValidationError("--as " + word, "unknown kind; see --as help");
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
      "stereo-sbs, stereo-tb, stereo-tracks: two views without depth, the left eye's left, on top, or in the first of "
      "two tracks; each eye is shown its own");
  addChoice(app, "--depth-code", source.depth_code, depthCodes(),
            "How depth is coded\n"
            "auto: hue if half of the picture is pure colour, else luma; luma: as brightness; hue: from red (near) "
            "through the colours back to red (far), also as RealSense and Record3D write it;\n"
            "others: colour maps; spectral: from blue to red, ylgnbu: from yellow to blue, kinect: black (no depth), "
            "blue, cyan, white");
  app.add_option_function<std::vector<std::string>>(
         "--calibration",
         [&source](const std::vector<std::string>& given) {
           for (const std::string& text : given) readCalibration(text, source);
         },
         "How to interpret depth codes; overrides the film's tags. Or a FILE with one KEY=VALUE per line\n"
         "law=linear|inverse: codes are proportional to distance or to 1/distance;\n"
         "polarity=near-high|near-low, range=full|limited, bits=8..16,\n"
         "codes=LOW-HIGH: the range of codes in use, if not all;\n"
         "invalid=CODE+CODE+LOW-HIGH..|none: codes of holes; unit=MM: codes are distances, MM mm each, from near to "
         "far;\n"
         "near=MM, far=MM: limits for distances and for the inverse law")
      ->allow_extra_args(false)
      ->type_name("FILE|KEY=VALUE,..");
  app.add_option_function<std::string>(
         "--registration",
         [&source](const std::string& path) {
           source.registration = readRegistration(path);
           source.named_files.push_back(path);
         },
         "TOML file with the poses of the depth and colour cameras; aligns the depth with the colour picture")
      ->type_name("FILE.toml");
}

void addMaterialOption(CLI::App& app, SourceOptions& source) {
  app.add_option_function<std::string>(
         "--material", [&source](const std::string& word) { source.material = readMaterial(word); },
         "What the surface feels like; overrides the film's tags and material track, part by part\n"
         "stiffness=N/MM [0.5, or what the device holds]; friction=STATIC/DYNAMIC: shares of what presses [0];\n"
         "texture=AMPLITUDE@WAVELENGTH: ripples, mm [0], such as stiffness=.3,friction=.2/.15,texture=.1@.8")
      ->type_name("KEY=VALUE,..");
}

void addMaterialOption(CLI::App& app, SourceOptions& source, std::string& map) {
  app.add_option_function<std::vector<std::string>>(
         "--material",
         [&source, &map](const std::vector<std::string>& given) {
           for (const std::string& word : given) {
             if (word.find('=') == std::string::npos) map = word;
             else source.material = readMaterial(word);
           }
         },
         "What the surface feels like: stiffness=N/MM, friction=STATIC/DYNAMIC: shares of what presses,\n"
         "texture=AMPLITUDE@WAVELENGTH: ripples, mm, such as stiffness=.3,friction=.2/.15,texture=.1@.8. Or at each\n"
         "place: FILE, a picture painted over the first picture of the film, which stays on its things, or a film of\n"
         "such pictures. Red is stiffness, green friction, blue texture; gray is stiffness alone; what is transparent\n"
         "is not painted. With it, KEY=VALUE says what full red, green and blue stand for\n"
         "[stiffness=1,friction=.6/.5,texture=.2@.8]")
      ->allow_extra_args(false)
      ->type_name("FILE|KEY=VALUE,..");
}

void addRateOption(CLI::App& app, SourceOptions& source) {
  app.add_option("--fps", source.frames_per_s,
                 "Frames per second of pictures that have numbers but no times [25; 30 if colour and depth are in one "
                 "folder]")
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
         "Box that the relief fills, mm\n[160 wide, 40 deep, height from the depth picture's aspect ratio]")
      ->type_name("WxHxD");
}

std::expected<void, int> parseCommandLine(CLI::App& program, int argc, const char* const* argv) {
  setHelp(program, program.get_name() + " " RELIEVO_VERSION);
  try {
    program.parse(argc, argv);
    return {};
  } catch (const KindsAsked&) {
    std::fputs(kindsText().c_str(), stdout);
    return std::unexpected(kExitDone);
  } catch (const WordFailure& failure) {
    return std::unexpected(tell(failure));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      program.exit(error);  // prints the help or the version
      return std::unexpected(kExitDone);
    }
    tellWrongUse(program, error);
    return std::unexpected(kExitWrongUse);
  }
}

CLI::Validator between(double low, double high) {
  const auto judge = [low, high](const std::string& word) -> std::string {
    double number = 0;
    const bool is_number = CLI::detail::lexical_cast(word, number);
    if (is_number && number >= low && number <= high) return {};
    std::ostringstream words;
    words << word << (is_number ? " is not between " : " is not a number; it is one between ") << low << " and "
          << high;
    return words.str();
  };
  return {judge, ""};
}

}  // namespace relievo

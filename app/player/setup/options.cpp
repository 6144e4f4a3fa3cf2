// SPDX-License-Identifier: Apache-2.0
// The commands of `relievo`, and the conversion of a command line to options.
#include "app/player/setup/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/program.h"
#include "app/player/setup/config_options.h"
#include "app/player/setup/help_texts.h"
#include "app/player/setup/play_options.h"
#include "app/player/setup/settle_play.h"
#include "platform/files/answered_place.h"
#include "platform/text/near_words.h"

namespace relievo {
namespace {

void addConfigOption(CLI::App& command, std::string& path) {
  command
      .add_option("--config", path,
                  "The configuration [~/.config/relievo/relievo.toml, else /etc/relievo/relievo.toml]")
      ->type_name("FILE")
      ->configurable(false);
}

Outcome<ConfigLines> readConfig(CLI::App& play, const std::string& path, FileConfig& config) {
  auto read = loadConfig(path);
  if (!read) return std::unexpected(read.error());
  config = std::move(*read);
  return play.parsed() ? applyConfig(play, config) : ConfigLines{};
}

// "relievo film.mkv" and "relievo --loop film.mkv" as "relievo play ..", "relievo help play" and "relievo play
// help" as "relievo play --help".
std::vector<const char*> withCommand(const CLI::App& program, int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  const std::string first = argc > 1 ? argv[1] : "";
  const auto isCommand = [&program](const std::string& word) {
    const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
    return std::ranges::any_of(commands, [&word](const CLI::App* each) { return each->get_name() == word; });
  };
  if (first == "help") {
    words.erase(words.begin() + 1);
    words.push_back("--help");
    return words;
  }
  if (argc == 3 && isCommand(first) && std::string_view(argv[2]) == "help" && !isThere("help")) words[2] = "--help";
  if (argc == 2 && first == "-v") return {argv[0], "--version"};
  constexpr std::array<std::string_view, 4> kOwn{"-h", "--help", "-V", "--version"};
  if (!isCommand(first) && std::ranges::find(kOwn, first) == kOwn.end()) words.insert(words.begin() + 1, "play");
  return words;
}

// A misspelt command would be taken as a film. `after`: the word after this one.
Outcome<void> refuseMisspeltCommand(const CLI::App& program, const std::string& word, const std::string& after) {
  std::vector<std::string> commands;
  for (const CLI::App* each : program.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(each->get_name());
  }
  const bool known = after.empty() || after.front() == '-' || std::ranges::find(commands, after) != commands.end();
  if (word == "help" && !known) {
    return failOn("help " + after, {ErrorCode::InvalidArgument, 0, "there is no such command; see relievo --help"});
  }
  const std::string near = nearestWord(word, commands);
  if (near.empty() || near == word || word.find_first_of("./:") != std::string::npos) return {};
  if (isThere(word)) return {};
  return failOn(word + " (" + near + "?)",
                {ErrorCode::InvalidArgument, 0, "is neither a file nor a command; see relievo --help"});
}

}  // namespace

std::expected<Options, int> parseOptions(int argc, const char* const* argv, const DeviceNames& names,
                                         const Machine& machine) {
  Options options;
  std::string config_path;
  bool print_config = false;
  CLI::App program(std::string(kAbout) + kProgramAbout, "relievo");
  program.footer(kProgramFooter);
  program.require_subcommand(1);
  CLI::App& play = *program.add_subcommand("play", kPlayAbout);
  CLI::App& probe = *program.add_subcommand("probe", "Show what a source contains, and what it needs");
  CLI::App& devices =
      *program.add_subcommand("devices", "List the devices of this machine, and why one cannot be used");
  CLI::App& self_test = *program.add_subcommand("selftest", "Test this installation, without any hardware");
  self_test.footer(kSelfTestFooter);
  CLI::App& calibrate = *devices.add_subcommand("calibrate", "Measure the Falcon's force with a spring scale");
  addPlayOptions(play, options.play, names);
  addConfigOption(play, config_path);
  play.add_flag("--print-config", print_config,
                "Print the settings that would be used, as a configuration, with the source of each value")
      ->configurable(false);
  const auto take = [&source = options.probe.source](const std::string& words) { source.url = sourceNamed(words); };
  probe.add_option_function<std::string>("SOURCE", take, kSourceHelp)->type_name(" ")->required();
  addDepthSource(probe, options.probe.source);
  probe.add_flag("--json", options.probe.json, "Print JSON, for programs");
  probe.footer(kProbeFooter);
  addConfigOption(devices, config_path);
  devices.footer(kDevicesFooter);
  calibrate.fallthrough();  // --config may come after it
  calibrate.footer(kCalibrateFooter);

  const auto words = withCommand(program, argc, argv);
  const std::string first = argc > 1 ? argv[1] : "";
  if (auto spelt = refuseMisspeltCommand(program, first, argc > 2 ? argv[2] : ""); !spelt)
    return std::unexpected(tell(spelt.error()));
  if (auto parsed = parseCommandLine(program, static_cast<int>(words.size()), words.data()); !parsed) {
    return std::unexpected(parsed.error());
  }
  options.command = probe.parsed()       ? Options::Command::Probe
                    : devices.parsed()   ? Options::Command::Devices
                    : self_test.parsed() ? Options::Command::SelfTest
                                         : Options::Command::Play;
  options.calibrate = calibrate.parsed();
  if (probe.parsed() || self_test.parsed()) return options;

  const auto lines = readConfig(play, config_path, options.config);
  if (!lines && options.play.from_desktop && !print_config) options.play.player.fault = lines.error();
  else if (!lines) return std::unexpected(tell(lines.error()));
  if (print_config) {
    std::fputs(configText(play, options.config, *lines).c_str(), stdout);
    return std::unexpected(kExitDone);
  }
  if (play.parsed()) {
    if (auto settled = settlePlay(options.play, machine); !settled) return std::unexpected(tell(settled.error()));
  }
  return options;
}

}  // namespace relievo

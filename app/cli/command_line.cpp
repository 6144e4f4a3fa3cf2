// SPDX-License-Identifier: Apache-2.0
// Parses a command line with CLI11, in the project's own words: help, version, and the one line for wrong use.
#include <algorithm>
#include <cstdio>
#include <ranges>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/program.h"
#include "platform/files/answered_place.h"
#include "platform/log.h"

namespace relievo {
namespace {

// "relievo play": the program and the command, if one was given.
std::string commandOf(const CLI::App& program) {
  std::string command = program.get_name();
  for (const CLI::App* given : program.get_subcommands()) command += " " + given->get_name();
  return command;
}

// The name of a command as it is typed, with its program's name before it.
std::string nameOf(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? command.get_name() : nameOf(*parent) + " " + command.get_name();
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

// CLI11 reports that an argument "was not expected"; this also names the option that was probably meant. Other players
// take one dash for two, as in -fs.
void tellUnexpected(const CLI::App& program, const std::string& word) {
  const bool one_dash = word.starts_with('-') && !word.starts_with("--");
  const std::string option = (one_dash ? "-" : "") + word.substr(0, word.find('='));
  log(LogLevel::Error, word.c_str(), "%s%s; see %s --help",
      word.starts_with('-') ? "no such option" : "is one argument too many",
      meant(option, optionsOf(*innermost(&program))).c_str(), commandOf(program).c_str());
}

bool isFlag(const CLI::Option& option) {
  return option.get_expected_max() == 0;
}

// An option of the given command, or of one that it belongs to; null: no such option.
const CLI::Option* optionOf(const CLI::App& program, const std::string& name) {
  const CLI::Option* option = nullptr;
  for (const CLI::App* at = innermost(&program); at != nullptr && option == nullptr; at = at->get_parent()) {
    option = at->get_option_no_throw(name);
  }
  return option;
}

void tellMissingValue(const std::string& command, const CLI::Option& option) {
  const std::string name = option.get_name();
  log(LogLevel::Error, name.c_str(), "its value is missing; write %s %s; see %s --help", name.c_str(),
      option.get_type_name().c_str(), command.c_str());
}

// CLI11 says "--fps: 1 required F missing", "--hip: At Most 1 required but received 2", "Could not convert: --osd = x".
// False if it says anything else.
bool tellWrongValue(const CLI::App& program, const std::string& what) {
  const std::size_t begin = what.starts_with("Could not convert: ") ? what.find(':') + 2 : 0;
  const std::string name = what.substr(begin, what.find_first_of(": ", begin) - begin);
  const CLI::Option* const option = optionOf(program, name);
  if (option == nullptr) return false;
  if (what.ends_with("missing")) {
    tellMissingValue(commandOf(program), *option);
    return true;
  }
  const bool flag = isFlag(*option), often = what.find("At Most") != std::string::npos;
  if (begin > 0 && !flag) {
    const std::string value = what.substr(std::min(what.size(), begin + name.size() + 3));  // after " = "
    log(LogLevel::Error, name.c_str(), "%s is not a number; see %s --help", value.c_str(), commandOf(program).c_str());
    return true;
  }
  if (!flag && !often) return false;
  log(LogLevel::Error, name.c_str(), "%s; see %s --help", flag ? "takes no value" : "was given more than once",
      commandOf(program).c_str());
  return true;
}

// The command that the words name, found before they are parsed.
const CLI::App* commandIn(const CLI::App& program, std::span<const char* const> words) {
  const CLI::App* command = &program;
  for (const char* const word : words) {
    const auto named = command->get_subcommands([&](const CLI::App* each) { return each->get_name() == word; });
    if (!named.empty()) command = named.front();
  }
  return command;
}

// In "--report --loop", "--loop" is not meant as a file's name, though CLI11 would take it as one; nor is "" in
// --report "$FILE", or the word after --report="$FILE", where no FILE was set.
const CLI::Option* withoutValue(const CLI::App& command, std::span<const char* const> words) {
  const std::vector<std::string> names = optionsOf(command);
  const auto taking = [&command](const std::string& name) -> const CLI::Option* {
    const CLI::Option* const option = command.get_option_no_throw(name);
    return option != nullptr && option->nonpositional() && !isFlag(*option) ? option : nullptr;
  };
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word(words[i]), name = word.substr(0, word.find('='));
    if (word == "--") break;  // films follow, whatever their names
    if (!word.empty() && std::ranges::find(names, name) == names.end()) continue;
    const CLI::Option* option = taking(words[i - 1]);
    if (option == nullptr && word == name + "=") option = taking(name);
    if (option != nullptr) return option;
  }
  return nullptr;
}

void tellWrongUse(CLI::App& program, const CLI::ParseError& error) {
  const auto commands = namesOf(program.get_subcommands([](const CLI::App*) { return true; }));
  const auto words = program.remaining(true);
  const bool known = commands.empty() || !program.get_subcommands().empty();
  if (known && !words.empty() && dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    tellUnexpected(program, words.front());
  } else if (known && tellWrongValue(program, error.what())) {
    return;
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
  const auto help = std::make_shared<Help>();
  help->label("SUBCOMMAND", "COMMAND");
  help->label("Positionals", "Arguments");
  help->label("REQUIRED", "(required)");
  app.formatter(help);
  app.set_version_flag("-V,--version", version, "Print the version and exit")->configurable(false);
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    command->group("Commands");
    setHelp(*command, version);
  }
}

}  // namespace

std::string singleWord(const std::string& word) {
  return word.starts_with('[') && word.ends_with(']') && isThere(word) ? "./" + word : word;
}

std::expected<void, int> parseCommandLine(CLI::App& program, int argc, const char* const* argv) {
  setHelp(program, program.get_name() + " " RELIEVO_VERSION);
  const std::span words(argv, static_cast<std::size_t>(argc));
  const CLI::App& command = *commandIn(program, words);
  if (const CLI::Option* const option = withoutValue(command, words)) {
    tellMissingValue(nameOf(command), *option);
    return std::unexpected(kExitWrongUse);
  }
  try {
    std::vector<std::string> last_first;
    for (const char* const word : std::views::reverse(words.subspan(1))) last_first.push_back(singleWord(word));
    program.parse(std::move(last_first));
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

}  // namespace relievo

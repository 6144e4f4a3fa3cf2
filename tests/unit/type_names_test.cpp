// SPDX-License-Identifier: Apache-2.0
// No two headers define a type of the same name: the linker would mix up their functions, and the reader their meaning.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Where each type of namespace scope is defined: "relievo::Frame" in "hal/media/frame.h".
class TypeNames {
 public:
  void read(const std::string& path, std::istream& text) {
    static const std::regex begin(R"(^namespace ([\w:]+) \{)");
    static const std::regex type(R"(^(?:class|struct|enum class) (\w+)(?: final)?(?: :.*)? \{)");
    static const std::regex alias(R"(^using (\w+) =)");
    std::string space;
    std::smatch match;
    for (std::string line; std::getline(text, line);) {
      if (std::regex_search(line, match, begin)) space = match[1];
      else if (std::regex_search(line, match, type) || std::regex_search(line, match, alias)) {
        files_[space + "::" + match[1].str()].push_back(path);
      }
    }
  }
  [[nodiscard]] std::size_t count() const { return files_.size(); }
  [[nodiscard]] std::vector<std::string> twice() const {
    std::vector<std::string> found;
    for (const auto& [name, files] : files_) {
      if (files.size() > 1) found.push_back(name + ": " + files[0] + ", " + files[1]);
    }
    return found;
  }

 private:
  std::map<std::string, std::vector<std::string>> files_;
};

TEST(TypeNames, EachIsThatOfOneType) {
  namespace fs = std::filesystem;
  const fs::path root = RELIEVO_SOURCE_DIR;
  TypeNames names;
  for (const char* top : {"platform", "hal", "drivers", "app"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (!entry.is_regular_file() || entry.path().extension() != ".h") continue;
      std::ifstream text(entry.path());
      names.read(entry.path().lexically_relative(root).generic_string(), text);
    }
  }
  ASSERT_GT(names.count(), 200U) << "the tree was not found";
  EXPECT_THAT(names.twice(), IsEmpty());
}

TEST(TypeNames, TwoOfOneNameAreSeen) {
  TypeNames names;
  std::istringstream one("namespace relievo {\nstruct Rgb {\n  struct Inner {\n  };\n};\nclass Later;\n}\n");
  std::istringstream other(
      "namespace relievo {\nusing Rgb = int;\nclass Later final : public Base {\n};\n}\n"
      "namespace relievo::test {\nstruct Inner {\n};\nstruct Later {\n};\n}\n");
  names.read("a.h", one);
  names.read("b.h", other);
  EXPECT_THAT(names.twice(), ElementsAre("relievo::Rgb: a.h, b.h"));
}

}  // namespace

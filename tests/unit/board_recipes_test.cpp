// SPDX-License-Identifier: Apache-2.0
// The recipes of Buildroot and Yocto name options, packages and a version that the build knows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace {

using testing::IsEmpty;
using Words = std::set<std::string>;

std::string textOf(const std::string& path) {
  std::ifstream file(RELIEVO_SOURCE_DIR "/" + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The first group of each match.
Words wordsOf(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  Words words;
  std::transform(std::sregex_iterator(text.begin(), text.end(), expression), {}, std::inserter(words, words.end()),
                 [](const std::smatch& match) { return match[1].str(); });
  return words;
}

const std::string kBuildroot = "toolchain/buildroot/package/relievo/relievo.mk";
const std::string kYocto = "toolchain/yocto/meta-relievo/recipes-multimedia/relievo/relievo.bb";

class BoardRecipes : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, BoardRecipes, testing::Values(kBuildroot, kYocto),
                         [](const auto& recipe) { return recipe.param == kYocto ? "Yocto" : "Buildroot"; });

// An option that is new in CMakeLists.txt is chosen in the recipes, too, unless it is a developer's.
TEST_P(BoardRecipes, EachOptionOfABoxIsChosen) {
  Words options = wordsOf(textOf("CMakeLists.txt"), R"(option\((RELIEVO_\w+))");
  for (const char* const developers : {"RELIEVO_WERROR", "RELIEVO_FUZZ"}) EXPECT_EQ(options.erase(developers), 1U);
  EXPECT_EQ(wordsOf(textOf(GetParam()), R"(-D(RELIEVO_\w+))"), options);
}

TEST_P(BoardRecipes, TheVersionIsTheProjects) {
  const Words version = wordsOf(textOf("CMakeLists.txt"), R"(project\(relievo VERSION ([0-9.]+))");
  EXPECT_EQ(wordsOf(textOf(GetParam()), R"((?:RELIEVO_VERSION|PV) = "?([0-9.]+))"), version);
}

// The development packages of Debian that a box needs, by their names in the recipe; optional ones follow their option.
TEST_P(BoardRecipes, EachLibraryOfTheBoxIsADependency) {
  const std::string recipe = textOf(GetParam());
  const bool yocto = GetParam() == kYocto;
  Words missing;
  for (const std::string name :
       {"alsa-lib", "cli11", "ffmpeg", "glm", "libass", "libdrm", "libevdev", "tomlplusplus", "tiff", "lz4", "bzip2",
        "zlib", "zstd", "libheif", yocto ? "sqlite3" : "sqlite", yocto ? "libusb1" : "libusb",
        yocto ? "libsdl2" : "sdl2", yocto ? "nlohmann-json" : "json-for-modern-cpp"}) {
    if (!std::regex_search(recipe, std::regex("[\\s\",]" + name + "[\\s\",]"))) missing.insert(name);
  }
  EXPECT_THAT(missing, IsEmpty());
  // A package that is added to CMakeLists.txt must be added here and in the list above.
  EXPECT_EQ(wordsOf(textOf("CMakeLists.txt"), R"((?:find_package|pkg_check_modules)\((\w+))"),
            (Words{"Threads", "PkgConfig", "glm",  "CLI11",  "tomlplusplus", "nlohmann_json", "FFMPEG", "TIFF", "ALSA",
                   "LIBUSB",  "LIBEVDEV",  "EGL",  "LIBDRM", "GBM",          "SDL2",          "GLES",   "ASS",  "LZ4",
                   "BZip2",   "ZLIB",      "ZSTD", "SQLITE", "GSTREAMER",    "OPENEXR",       "HEIF"}));
}

}  // namespace

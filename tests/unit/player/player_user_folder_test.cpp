// SPDX-License-Identifier: Apache-2.0
// The folders that a desktop has written down, in the form of user-dirs.dirs(5).
#include "app/player/user_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace relievo {
namespace {

namespace fs = std::filesystem;

class UserFolder : public testing::Test {
 protected:
  UserFolder() {
    fs::create_directories(folder_ / ".config");
    ::setenv("HOME", folder_.c_str(), 1);
    for (const char* const name : {"XDG_CONFIG_HOME", "XDG_VIDEOS_DIR", "XDG_PICTURES_DIR"}) ::unsetenv(name);
  }
  ~UserFolder() override { fs::remove_all(folder_); }
  void write(const fs::path& config, const std::string& text) {
    fs::create_directories(config);
    std::ofstream(config / "user-dirs.dirs") << text;
  }
  const fs::path folder_ = fs::path(testing::TempDir()) / "relievo-user-folder";
};

TEST_F(UserFolder, IsTheOneThatTheDesktopHasWrittenDown) {
  write(folder_ / ".config",
        "# XDG_VIDEOS_DIR=\"$HOME/no\"\nXDG_PICTURES_DIR=\"$HOME/Bilder \\\"neu\\\"\"\n"
        "XDG_VIDEOS_DIR=\"/daten/Vidéos\"\nXDG_MUSIC_DIR=\"$HOME/\"\nXDG_DESKTOP_DIR=\"Desktop\"\n");
  EXPECT_EQ(userFolder("XDG_PICTURES_DIR"), folder_ / "Bilder \"neu\"");
  EXPECT_EQ(userFolder("XDG_VIDEOS_DIR"), "/daten/Vidéos");
  EXPECT_EQ(userFolder("XDG_MUSIC_DIR"), "") << "the home itself means none";
  EXPECT_EQ(userFolder("XDG_DESKTOP_DIR"), "") << "relative";
  EXPECT_EQ(userFolder("XDG_TEMPLATES_DIR"), "") << "not written down";
}

TEST_F(UserFolder, IsWhatTheEnvironmentSaysBeforeThat) {
  write(folder_ / "own", "XDG_VIDEOS_DIR=\"$HOME/Filme\"\n");
  EXPECT_EQ(userFolder("XDG_VIDEOS_DIR"), "") << "no file in ~/.config";
  ::setenv("XDG_CONFIG_HOME", (folder_ / "own").c_str(), 1);
  EXPECT_EQ(userFolder("XDG_VIDEOS_DIR"), folder_ / "Filme");
  ::setenv("XDG_VIDEOS_DIR", "/films", 1);
  EXPECT_EQ(userFolder("XDG_VIDEOS_DIR"), "/films");
  ::unsetenv("XDG_CONFIG_HOME");
  ::unsetenv("XDG_VIDEOS_DIR");
}

}  // namespace
}  // namespace relievo

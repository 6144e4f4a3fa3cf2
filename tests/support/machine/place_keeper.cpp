// SPDX-License-Identifier: Apache-2.0
// A program that keeps places of films in the file it is given, again and again, until it is killed.
#include <cstdio>
#include <string>

#include "app/player/file_writer.h"
#include "app/player/film/resume.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("place_keeper: one argument is needed: the file to keep places in\n", stderr);
    return 2;
  }
  relievo::FileWriter files;
  relievo::Resume resume(argv[1], files);
  for (int i = 1;; ++i) {
    resume.keep("film " + std::to_string(i % 150) + std::string(2000, 'x'), relievo::mediaTime(2 + i));
  }
}

// SPDX-License-Identifier: Apache-2.0
// The beginnings and ends of the help of `relievo` and of its commands.
#pragma once

namespace relievo {

inline constexpr const char* kAbout =
    "relievo: 3D video you can touch. Plays colour + depth video; a force-feedback device lets you feel its relief.\n";
inline constexpr const char* kProgramAbout =
    "\n  relievo film.mkv          plays it: in a window on a desktop; without a desktop, on the whole screen\n"
    "  relievo                   shows a list of films to choose from\n"
    "  relievo help COMMAND      shows the options of a command; `relievo help play` begins with the most frequent "
    "uses\n";
inline constexpr const char* kProgramFooter =
    "\nExamples:\n"
    "  relievo film.mkv                               in a window; press into the picture with the mouse to feel it\n"
    "  relievo probe scan.mov --packing tb --depth-code hue\n"
    "                                                 what the file contains; you say that colour is on top\n"
    "                                                 and depth, as hue, below it\n"
    "  relievo devices                                which devices are there, and why one cannot be used\n"
    "  relievo selftest                               tests this installation, without any hardware\n"
    "\nTo play a file that is named like a command, give its path, such as ./play. `relievo-author --help` tells how\n"
    "to make a film.\n";
inline constexpr const char* kProbeFooter =
    "\nExamples:\n"
    "  relievo probe film.mkv                         its tracks, what its depth means, what a finger will feel of it\n"
    "  relievo probe color.webm --depth depth.webm    two files\n"
    "  relievo probe --json film.mkv                  for programs\n"
    "\nIt prints: tracks; `meaning`: each value of the calibration and who said it; `relief`: the codes and "
    "heights in\n"
    "use; `touch`: how much the relief is smoothed for the finger, and the remaining error; `needs`: what "
    "the\n"
    "film asks for or lacks, and the option to try. Exit code: 0 done, 1 failed at run time, 2 usage error.\n";
inline constexpr const char* kDevicesFooter =
    "\nEach display and device is opened as `play` would open it; if that fails, its line says why and what to do. "
    "For a\nscreen, it lists the mode and the supported 3D signals.\n"
    "\nThe configuration (TOML; `relievo play --print-config` shows one) has a section for a Falcon:\n"
    "  [falcon]\n"
    "  firmware = \"/path/to/image\"    the maker's firmware, from the SDK that came with the device\n"
    "  counts_per_nm = 6000           its strength, as measured by `relievo devices calibrate`\n";
inline constexpr const char* kCalibrateFooter =
    "\nHook a spring scale to the Falcon's grip and pull it out to the middle of its range. The grip pushes toward you "
    "with\n2, 3 and 4 N in turn: type what the scale shows each time, in newtons. The result goes into the "
    "configuration,\nwhere `relievo play` finds it. Until then the highest strength that users have reported is "
    "assumed, so that the\nforce is never larger than requested.\n";
inline constexpr const char* kSelfTestFooter =
    "\nIt looks for a font and the decoders, and plays a film of its own for three seconds off screen, touched by the\n"
    "simulated hand. Each line begins with `good`, `note` (works without it, but less well) or `bad`. Exit code: 0 "
    "nothing "
    "is\n"
    "bad, 1 something is, 2 usage error.\n";
inline constexpr const char* kExitCodes =
    "\nExit code: 0 done, 1 failed at run time, or a film that was played to its end was not whole, 2 usage error.\n";
inline constexpr const char* kPlayAbout =
    "Play a film: shown in stereo, felt by the finger\n"
    "\n  relievo film.mkv                         in a window; press into the picture with the mouse to feel it\n"
    "  relievo one.mkv two.mkv films/           one film after the other, and those of a folder; --loop repeats\n"
    "  relievo color.mp4 --depth depth.mkv      colour and depth are two files\n"
    "  relievo scan.mov --packing tb            colour on top, depth below in one picture; sbs: side by side\n"
    "  relievo film.mkv --start 1:30            from that time on\n"
    "  relievo film.mkv --stereo anaglyph       for red-cyan glasses; sbs, tab: for a 3D screen\n"
    "  relievo film.mkv --display kms           on a whole screen without a desktop\n"
    "  relievo film.mkv --haptic falcon         felt with a force-feedback device; a second --haptic adds a finger\n"
    "  relievo film.mkv --resume                from where it was left\n"
    "  relievo                                  a list of films to choose from; --films FOLDER: those of a folder\n"
    "  relievo https://example.org/film.m3u8    from the network\n"
    "  relievo film-3d.mkv --depth-from stereo  a 3D film that has two views and no depth, felt\n"
    "  relievo v4l2:/dev/video0 --calibration near=400,far=1500\n"
    "                                           a depth camera, live\n"
    "\nKeys: space pauses, arrows seek, f fills the screen, h shows all keys, q ends it.";
inline constexpr const char* kPlayFooter =
    "\nExamples:\n"
    "  relievo color.webm --depth depth.webm --display offscreen --report run.json\n"
    "      two files, shown off screen, touched by the simulated hand; the figures go to run.json\n"
    "  relievo play scan.mov --packing tb --depth-code hue --stereo anaglyph --loop --duration 60\n"
    "      one file with colour on top and depth as hue below, for red-cyan glasses, repeated for a minute\n"
    "  relievo play film.mkv --display offscreen:film.y4m --haptic sim:hand.csv --remote script:keys.txt\n"
    "      the picture into a file that ffmpeg reads, finger and keys by scripts\n"
    "  relievo play film.mkv --display kms --size 1920x1080 --haptic falcon\n"
    "      on a whole screen of the box, without a desktop\n"
    "  relievo play evening.m3u --loop --resume\n"
    "      the films of a list, from where they were left\n"
    "  relievo play --control /run/user/1000/relievo\n"
    "      waits; a program opens films by lines such as {\"do\": \"open film.mkv\"}, and gets events\n"
    "\nEvery option can stand in the configuration by its long name, SOURCE as source:\n"
    "  [play]\n"
    "  display = \"kms\"\n"
    "  loop = true\n"
    "  [log]\n"
    "  all = \"warning\"                error, warning, info, debug; or for an area, as haptic = \"debug\"\n"
    "\nA hand script is a CSV file: the line t_s,x_mm,y_mm,z_mm, then a row for each moment; x right, y up, z toward "
    "the viewer, 0,0,0 in "
    "the\n"
    "middle of the far plane. A key script has lines such as: 2.5 PLAYPAUSE (seconds, a key's name). Keys, by their "
    "names:\n";
inline constexpr const char* kSourceHelp =
    "A film, a folder of films or pictures, pictures (\"a/%06d.png\", \"a/*.png\"), associations.txt, a playlist, or "
    "an "
    "address: http, https (HLS as well), rtsp, rtp, udp, tcp, srt; v4l2:DEVICE; mock:, which needs no file";

}  // namespace relievo

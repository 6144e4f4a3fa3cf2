// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/folder.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "drivers/pictures/endings.h"
#include "drivers/pictures/listed.h"
#include "drivers/pictures/lists.h"
#include "drivers/pictures/odometry.h"
#include "drivers/pictures/other_files.h"
#include "drivers/pictures/pattern.h"
#include "drivers/pictures/roles.h"
#include "drivers/pictures/stereo.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_place.h"
#include "platform/text/lower_case.h"
#include "platform/whole_file.h"

namespace relievo::pictures {
namespace {

constexpr const char* kUnsaid =
    "its pictures are in folders whose names do not say which are colour and which depth; give the folder of colour, "
    "and --depth with that of depth";
constexpr const char* kSeveral = "this folder holds several recordings; name one of the folders in it";
constexpr const char* kHasFilms =
    "this folder is a list of films; name one of them, or play them all with relievo play";
constexpr const char* kNoList = "cannot be read; name a list of pictures such as associations.txt";

constexpr std::size_t kMostListed = 2000;  // folders

struct Path {
  std::string folder, name;
  explicit Path(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    folder = slash == path.npos ? "" : path.substr(0, slash + 1);
    name = path.substr(folder.size());
  }
};

// "c" of "a/b/c/".
std::string folderOf(const std::string& path) {
  return Path(path.substr(0, path.rfind('/'))).name;
}

// Sorts pictures of one folder by the words in their names. Beside names that say depth, all others are colour.
void sortByRole(const std::string& folder, const std::vector<std::string>& names, FoundPictures& found) {
  auto by_role = byRole(names);
  auto& depth = by_role[Role::Depth];
  if (depth.empty()) {
    std::vector<std::string> color = names;
    const std::size_t others = by_role[Role::Other].size(), rest = names.size() - others;
    if (!by_role[Role::Color].empty() || (rest > 0 && 2 * others >= rest))  // a single cover may be a photo
      found.left_out += std::erase_if(color, [](const std::string& name) { return roleOf(name) == Role::Other; });
    found.depth = {folder, takeDepthOfPhotos(folder, color)};
    found.color = {folder, oneKind(std::move(color), Role::Color, found.left_out)};
    return;
  }
  auto& color = by_role[Role::Color].empty() ? by_role[Role::Unsaid] : by_role[Role::Color];
  keepLeftView(depth), keepLeftView(color);
  if (auto views = viewsAmong(color); views && color.size() == 2 * depth.size()) color = std::move(views->left);
  found.left_out += names.size() - depth.size() - color.size();
  found.depth = {folder, chosen(depth, Role::Depth, found.left_out)};
  found.color = {folder, oneKind(color, Role::Color, found.left_out)};
}

// The pictures in `folder`, or else in the first of its own folders that has any ("depth/Camera_0"), or of theirs
// ("disparity/TRAIN/A/0000/left").
PictureFiles picturesIn(const std::string& folder, Role role, FoundPictures& found, std::size_t& may_list,
                        int levels = 4) {
  constexpr std::size_t kMostFolders = 16;
  auto listing = listingOf(folder, may_list).value_or(Listing{});
  if (!listing.pictures.empty()) return {folder, chosen(std::move(listing.pictures), role, found.left_out)};
  std::ranges::sort(listing.folders, naturalLess);
  listing.folders.resize(std::min(listing.folders.size(), levels > 0 ? kMostFolders : 0));
  for (const std::string& name : listing.folders) {
    auto inner = picturesIn(folder + name + "/", role, found, may_list, levels - 1);
    if (!inner.names.empty()) return inner;
  }
  return {folder, {}};
}

// Beside depth without colour: the folder whose name says nothing ("frames", "JPEGImages") but whose pictures have most
// of the depth's names, or at least their number; of equal ones that of photographs. The others are told.
PictureFiles colorBeside(const std::string& folder, const Listing& listing, FoundPictures& found,
                         std::size_t& may_list) {
  std::map<std::string, std::pair<std::size_t, bool>> worth;
  for (const std::string& name : listing.folders) {
    const bool depth = found.depth.folder.starts_with(folder + name + "/");
    if (depth || roleOf(name) != Role::Unsaid || isPainted(name) || lowerCase(name) == "alpha") continue;
    const auto pictures = listingOf(folder + name, may_list).value_or(Listing{}).pictures;
    if (!pictures.empty()) worth[name] = {likeness(pictures, found.depth.names), holdsPhotograph(pictures)};
  }
  const auto best = std::ranges::max_element(worth, {}, [](const auto& entry) { return entry.second; });
  const std::string taken = best != worth.end() && best->second.first > 0 ? best->first : "";
  const std::string why = taken.empty() ? "its pictures have no names of the depth's" : taken + " is taken for colour";
  for (const auto& [name, value] : worth) {
    if (name != taken) found.notes.push_back(std::string(name).append(" is left out: ").append(why));
  }
  return taken.empty() ? PictureFiles{} : picturesIn(folder + taken + "/", Role::Color, found, may_list);
}

// Where no name says depth: the only folder whose pictures are numbers, beside another one with their names; it is
// told.
PictureFiles depthByForm(const std::string& folder, const Listing& listing, FoundPictures& found,
                         std::size_t& may_list) {
  constexpr std::size_t kMostFolders = 16;
  std::map<std::string, std::vector<std::string>> pictures;
  std::vector<std::string> numbers;  // folders
  if (listing.folders.size() > kMostFolders) return {};
  for (const std::string& name : listing.folders) {
    auto names = listingOf(folder + name, may_list).value_or(Listing{}).pictures;
    if (names.empty() || roleOf(name) == Role::Other) continue;
    const std::string first = folder + name + "/" + *std::ranges::min_element(names, naturalLess);
    if (holdsNumbers(first)) numbers.push_back(name);
    pictures[name] = std::move(names);
  }
  const auto isLike = [&](const auto& entry) {
    return entry.first != numbers.front() && likeness(entry.second, pictures[numbers.front()]) > 0;
  };
  if (numbers.size() != 1 || std::ranges::none_of(pictures, isLike)) return {};
  found.notes.push_back(numbers.front() + " is taken for depth: its pictures are numbers, or gray of 16 bits");
  return picturesIn(folder + numbers.front() + "/", Role::Depth, found, may_list);
}

// The colour of depth in a deeper folder, in folders of this role: the first one with the same folders in it
// ("frames/a/left" for "disparity/a/left"), or that of the depth's name (KITTI's "image_02"). Empty if there is none.
PictureFiles colorInside(const std::string& folder, const Listing& listing, Role role, FoundPictures& found,
                         std::size_t& may_list) {
  const std::string& depth = found.depth.folder;
  if (!depth.starts_with(folder)) return {};
  const std::size_t deeper = depth.find('/', folder.size()) + 1;
  if (deeper == depth.size()) return {};
  std::vector<std::string> names = listing.folders;
  std::erase_if(names, [role](const std::string& name) { return roleOf(name) != role || isPainted(name); });
  std::ranges::sort(names, naturalLess);
  for (const std::string& name : names) {
    const std::string inner = folder + name + "/" + depth.substr(deeper);
    if (auto files = picturesIn(inner, Role::Color, found, may_list, 0); !files.names.empty()) return files;
  }
  const bool named = std::ranges::find(names, folderOf(depth)) != names.end();
  return named ? picturesIn(folder + folderOf(depth) + "/", Role::Color, found, may_list) : PictureFiles{};
}

bool sortByFolder(const std::string& folder, const Listing& listing, FoundPictures& found, std::size_t& may_list) {
  const auto open = [&](Role role) -> PictureFiles {
    const std::string name = bestOf(listing.folders, role);
    return name.empty() ? PictureFiles{} : picturesIn(folder + name + "/", role, found, may_list);
  };
  found.depth = open(Role::Depth);
  if (found.depth.names.empty()) found.depth = depthByForm(folder, listing, found, may_list);
  found.color = colorInside(folder, listing, Role::Color, found, may_list);
  if (found.color.names.empty()) found.color = open(Role::Color);
  if (found.color.names.empty()) found.color = colorInside(folder, listing, Role::Unsaid, found, may_list);
  if (found.color.names.empty() && !found.depth.names.empty()) {
    const auto stereo = stereoAmong(listing.folders, Named::Folders);
    found.color = stereo ? picturesIn(folder + stereo->left + "/", Role::Color, found, may_list)
                         : PictureFiles{folder, oneKind(listing.pictures, Role::Color, found.left_out)};
    if (stereo) found.left_out += picturesIn(folder + stereo->right + "/", Role::Color, found, may_list).names.size();
    if (found.color.names.empty()) found.color = colorBeside(folder, listing, found, may_list);
  }
  return !found.color.names.empty() || !found.depth.names.empty();
}

// One picture of two cameras: of its depth if that is known, else of both views. Or the views of many.
bool sortByView(const std::string& folder, const std::vector<std::string>& names, FoundPictures& found) {
  const auto stereo = stereoAmong(names, Named::Pictures);
  if (!stereo) {
    auto views = viewsAmong(names);
    if (!views) return false;
    found.views = true;
    found.color = {folder, std::move(views->left)};
    found.depth = {folder, std::move(views->right)};
    return true;
  }
  found.views = stereo->depth.empty();
  found.color = {folder, {stereo->left}};
  found.depth = {folder, {found.views ? stereo->right : stereo->depth}};
  found.left_out += names.size() - (found.views ? 2 : 3);
  return true;
}

// Two folders of views. KITTI-360's fisheyes (data_rgb) look to either side.
bool sortByViewFolder(const std::string& folder, const Listing& listing, FoundPictures& found, std::size_t& may_list) {
  std::vector<std::string> names = listing.folders;
  std::erase_if(names, [&](const std::string& name) { return isFolder(folder + name + "/data_rgb"); });
  const auto stereo = stereoAmong(names, Named::Folders);
  if (!stereo || !stereo->depth.empty()) return false;
  FoundPictures views{.views = true};
  views.color = picturesIn(folder + stereo->left + "/", Role::Color, views, may_list);
  views.depth = picturesIn(folder + stereo->right + "/", Role::Color, views, may_list);
  if (views.color.names.empty() || views.depth.names.empty()) return false;
  found = std::move(views);
  return true;
}

Result<FoundPictures> findInFolder(const std::string& folder, std::size_t& may_list, int levels = 2);

// For a folder without pictures of its own: the recording in its only sub-folder that has one ("keyframes", "results"),
// or in that of the first of several cameras ("cam_0"). NotFound, or why one below cannot be read.
Result<FoundPictures> findAmong(const std::string& folder, const std::vector<std::string>& names, std::size_t& may_list,
                                int levels) {
  Result<FoundPictures> found = fail(ErrorCode::NotFound, kNoPictures);
  std::vector<FoundPictures> views;
  bool cameras = true;
  for (const std::string& name : names) {
    auto below = findInFolder(folder + name + "/", may_list, levels);
    if (!below && below.error().code == ErrorCode::Unsupported && !found) found = std::unexpected(below.error());
    if (!below || below->color.names.empty() || below->depth.names.empty()) continue;
    if (below->views) {
      views.push_back(*std::move(below));
      continue;
    }
    cameras = cameras && lowerCase(name).starts_with("cam");
    if (found && !cameras) return fail(ErrorCode::Unsupported, kSeveral);
    if (found) found->left_out += below->color.names.size() + below->depth.names.size();
    else found = *std::move(below);
  }
  if (!found && views.size() == 1) found = std::move(views.front());
  return found;
}

// The same, one folder down, or else as deep as `levels`; two views only if there is no depth.
Result<FoundPictures> findBelow(const std::string& folder, Listing listing, std::size_t& may_list, int levels) {
  constexpr std::size_t kMostFolders = 16;
  Result<FoundPictures> found = fail(ErrorCode::NotFound, kNoPictures);
  if (listing.folders.size() > kMostFolders) return found;
  std::ranges::sort(listing.folders, naturalLess);
  for (int deeper = 0; deeper < levels && (!found || found->views); ++deeper) {
    auto here = findAmong(folder, listing.folders, may_list, deeper);
    if (!found || (here && !here->views)) found = std::move(here);
  }
  return found;
}

Result<FoundPictures> findInFolder(const std::string& folder, std::size_t& may_list, int levels) {
  if (auto listed = findListed(folder)) return *std::move(listed);
  const auto listing = listingOf(folder, may_list);
  if (!listing) return std::unexpected(listing.error());
  FoundPictures found;
  const bool sorted = sortByFolder(folder, *listing, found, may_list);
  if (sorted && !found.depth.names.empty() && !found.color.names.empty()) return found;
  const bool goes_down = levels > 0 && listing->pictures.empty() && listing->films == 0;
  auto below = goes_down ? findBelow(folder, *listing, may_list, levels) : fail(ErrorCode::NotFound, kNoPictures);
  if (below) return below;
  if (found.depth.names.empty() && sortByViewFolder(folder, *listing, found, may_list)) return found;
  if (sorted && below.error().code == ErrorCode::Unsupported) found.notes.emplace_back(below.error().message);
  if (sorted) return found;
  found = {};
  if (isListOfFilms(listing->films, listing->pictures.size())) return fail(ErrorCode::NotFound, kHasFilms);
  if (listing->pictures.empty() && listing->way != nullptr) return fail(ErrorCode::Unsupported, listing->way);
  const auto hasPictures = [&](const std::string& name) {
    return !listingOf(folder + name, may_list).value_or(Listing{}).pictures.empty();
  };
  if (listing->pictures.empty() && below.error().code == ErrorCode::NotFound &&
      std::ranges::count_if(listing->folders, hasPictures) > 1)
    return fail(ErrorCode::NotFound, kUnsaid);
  if (listing->pictures.empty()) return below;
  if (!sortByView(folder, listing->pictures, found)) sortByRole(folder, listing->pictures, found);
  if (found.depth.names.empty()) takeOdometryTimes(found);
  if (found.depth.names.empty() && listing->way != nullptr) found.notes.emplace_back(listing->way);
  return found;
}

}  // namespace

std::string pathOf(const std::string& url) {
  if (!url.starts_with("file:") || isRegularFile(url) || isFolder(url)) return url;
  return url.substr(url.starts_with("file:///") ? 7 : 5);
}

bool namesPictures(const std::string& url) {
  const std::string path = pathOf(url);
  if (isFolder(path)) return true;
  if (isRegularFile(path)) return mediaKindOf(path) == MediaKind::Picture || endingOf(path) == "txt";
  return isPattern(Path(path).name) && url.find("://") == url.npos;
}

Result<FoundPictures> findPictures(const std::string& url) {
  const std::string path = pathOf(url);
  std::size_t may_list = kMostListed;
  if (isFolder(path)) return findInFolder(path.ends_with('/') ? path : path + "/", may_list);
  const Path parts(path);
  if (!isRegularFile(path)) return findByPattern(parts.folder, parts.name);
  if (endingOf(path) != "txt") return FoundPictures{.color = {parts.folder, {parts.name}}};
  const auto text = readWholeFile(path, FileSize::Recording, kNoList);
  if (!text) return std::unexpected(text.error());
  const auto list = parsePictureList(*text, 2);
  if (!list) return std::unexpected(list.error());
  return fromAssociations(parts.folder, *list);
}

}  // namespace relievo::pictures

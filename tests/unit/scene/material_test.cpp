// SPDX-License-Identifier: Apache-2.0
// The words of a material, and what a device can hold of it.
#include "app/scene/material.h"

#include <gtest/gtest.h>

#include <numbers>

namespace relievo {
namespace {

TEST(Material, IsReadFromWords) {
  const auto all = parseMaterial("stiffness=.3,friction=.2/.15,texture=.1@.8");
  ASSERT_TRUE(all.has_value());
  EXPECT_EQ(all->stiffness_n_per_mm, 0.3);
  EXPECT_EQ(all->friction, (Friction{0.2, 0.15}));
  EXPECT_EQ(all->texture, (Texture{0.1, 0.8}));
  const auto friction = parseMaterial("friction=0.4");
  ASSERT_TRUE(friction.has_value());
  EXPECT_EQ(friction->friction, (Friction{0.4, 0.4})) << "one number stands for both";
  EXPECT_FALSE(friction->stiffness_n_per_mm || friction->texture);
  EXPECT_EQ(parseMaterial("texture=0")->texture->amplitude_mm, 0) << "none";
}

TEST(Material, RefusesWhatIsNoMaterialAndSaysWhatIs) {
  const auto messageOf = [](const char* text) {
    const auto material = parseMaterial(text);
    return material ? std::string() : std::string(material.error().message);
  };
  for (const char* text : {"", ",", "0.3", "stiff=1", "stiffness", "Stiffness=1"}) {
    EXPECT_NE(messageOf(text).find("STATIC/DYNAMIC"), std::string::npos) << text;
  }
  for (const char* text : {"stiffness=", "stiffness=0", "stiffness=-1", "stiffness=nan", "stiffness=inf",
                           "stiffness=101", "stiffness=1 ", "stiffness=1e999", "stiffness=1=2"}) {
    EXPECT_NE(messageOf(text).find("N/mm"), std::string::npos) << text;
  }
  for (const char* text : {"friction=", "friction=.2/.3", "friction=2.1", "friction=.2/", "friction=/.2",
                           "friction=.2/.1/.1", "friction=-0.1", "friction=nan/nan"}) {
    EXPECT_NE(messageOf(text).find("static/dynamic"), std::string::npos) << text;
  }
  for (const char* text : {"texture=.1", "texture=@1", "texture=.1@", "texture=.1@0", "texture=3@1", "texture=.1@101",
                           "texture=.1@.8@.8", "texture=inf@1"}) {
    EXPECT_NE(messageOf(text).find("AMPLITUDE@WAVELENGTH"), std::string::npos) << text;
  }
}

TEST(Material, ReadsBackWhatItWrites) {
  for (const char* text : {"stiffness=0.3", "friction=0.2/0.15", "texture=0.1@0.8", "texture=0",
                           "stiffness=0.1,friction=0/0,texture=2@100"}) {
    EXPECT_EQ(materialText(*parseMaterial(text)), text);
  }
  EXPECT_EQ(*parseMaterial("texture=.0@.8"), *parseMaterial("texture=0")) << "no ripple has no length";
  EXPECT_EQ(materialText({}), "");
}

TEST(Material, OfTheCommandLineStandsAboveThatOfTheTags) {
  const auto tagged = materialFromTags({{"DEPTH_MATERIAL", "stiffness=1,friction=.5"}, {"DEPTH_LAW", "linear"}});
  ASSERT_TRUE(tagged.has_value());
  EXPECT_EQ(layered(*parseMaterial("friction=0,texture=.1@1"), *tagged),
            *parseMaterial("stiffness=1,friction=0,texture=.1@1"));
  EXPECT_TRUE(materialFromTags({{"DEPTH_LAW", "linear"}})->empty());
  EXPECT_FALSE(materialFromTags({{"DEPTH_MATERIAL", "soft"}}).has_value());
}

TEST(HeldMaterial, IsWhatTheFilmAsksForWhereTheDeviceHoldsIt) {
  const HeldMaterial usual = heldBy({}, 0.5, 2, 8);
  EXPECT_EQ(usual.stiffness_n_per_mm, 0.5);
  EXPECT_EQ(usual.friction, Friction{});
  EXPECT_EQ(usual.texture.amplitude_mm, 0);
  EXPECT_EQ(usual.reduced, "");
  EXPECT_EQ(heldBy({}, 0.5, 0.4, 8).stiffness_n_per_mm, 0.4);
  EXPECT_EQ(heldBy({}, 0.5, 0.4, 8).reduced, "") << "nobody asked for more";
  const HeldMaterial held = heldBy(*parseMaterial("stiffness=2,friction=.9/.7,texture=.1@.8"), 0.5, 2, 8);
  EXPECT_EQ(held.stiffness_n_per_mm, 2);
  EXPECT_EQ(held.friction, (Friction{0.9, 0.7}));
  EXPECT_EQ(held.texture, (Texture{0.1, 0.8}));
  EXPECT_EQ(held.reduced, "");
}

TEST(HeldMaterial, IsBoundedByTheDevicesStiffnessAndForce) {
  const HeldMaterial soft = heldBy(*parseMaterial("stiffness=3"), 0.5, 0.8, 8);
  EXPECT_EQ(soft.stiffness_n_per_mm, 0.8);
  EXPECT_EQ(soft.reduced, "stiffness 3 N/mm is felt as 0.8");
  // The steepest slope of a ripple is 2 pi A/L: at .8 of .8 N/mm it is 1 where A = L/2 pi.
  const HeldMaterial steep = heldBy(*parseMaterial("stiffness=3,texture=1@.8"), 0.5, 0.8, 8);
  EXPECT_NEAR(steep.texture.amplitude_mm, 0.8 / (2 * std::numbers::pi), 1e-12);
  EXPECT_EQ(steep.reduced, "stiffness 3 N/mm is felt as 0.8; texture of 1 mm is felt as 0.127");
  // A quarter of 2 N is 0.5 N: 1 mm of 0.5 N/mm.
  EXPECT_NEAR(heldBy(*parseMaterial("texture=2@50"), 0.5, 0.8, 2).texture.amplitude_mm, 1, 1e-12);
}

TEST(Material, OfATrackIsBoundByTheDeviceAtEachPlace) {
  const Material full = *parseMaterial("stiffness=2,texture=.2@3");
  const HeldScale held = scaleHeldBy(full, *parseMaterial("friction=.3"), 0.8, 4);
  EXPECT_EQ(held.stiffness_n_per_mm, 2) << "codes keep their meaning";
  EXPECT_EQ(held.most_n_per_mm, 0.8);
  EXPECT_NEAR(held.most_ripple_n, 0.8 * 3 / (2 * std::numbers::pi), 1e-12) << "as steep as the stiffness held";
  EXPECT_EQ(scaleHeldBy(full, {}, 0.8, 1).most_ripple_n, 0.25) << "a quarter of the force";
  EXPECT_FALSE(held.friction.has_value()) << "not in the track";
  EXPECT_NE(reducedScale(full, 0.8).find("0.8 N/mm"), std::string::npos);
  EXPECT_EQ(reducedScale(full, 2), "");
  EXPECT_EQ(withoutThoseOf(*parseMaterial("stiffness=1"), full), *parseMaterial("texture=.2@3"));
}

}  // namespace
}  // namespace relievo

// What a scene file may not say, and how it is told so: with the place, and what was probably meant.
#include <catch2/catch.hpp>
#include <random>

#include "error.h"
#include "support/scene_text.h"
#include "test_paths.h"

using namespace vkvol;

TEST_CASE("what is not rendered is said, with its place", "[cpu][xml]") {
    const auto warning = [](const std::string& body) {
        const Scene scene = parse_scene("<options>\n" + body + "\n<sphere/></options>", "s.xml");
        return scene.warnings.size() == 1 ? scene.warnings[0] : std::to_string(scene.warnings.size()) + " warnings";
    };
    CHECK_THAT(warning("  <importanceSampling>true</importanceSampling>"), Catch::StartsWith("s.xml:2:3: importance"));
    CHECK_THAT(warning(R"(<stepSize min=".1" max="1"/>)"),
               Catch::StartsWith("s.xml:2:1: stepSize") && Catch::Contains("without steps"));
    CHECK_THAT(warning(R"(<stepSize min=".1" max="1"/><integrator>rayMarching</integrator>)"),
               Catch::StartsWith("s.xml:2:1: stepSize") && Catch::Contains("<march> has the steps of rayMarching"));
    CHECK_THAT(warning(R"(<march step="1"/><integrator>ratioTracking</integrator>)"),
               Catch::Contains("<march> step is without effect: ratioTracking"));
    CHECK_THAT(warning(R"(<march jitter="true"/><integrator>homogeneousRayMarcherNEE</integrator>)"),
               Catch::Contains("the middle of its steps"));
    CHECK_THAT(warning(R"(<march unit="voxel"/><integrator>rayMarching</integrator>)"), Catch::Contains("world units"));
    CHECK_THAT(warning("<sigma_s>1</sigma_s><integrator>densitySampling</integrator>"), Catch::Contains("sigma_s out"));
    CHECK_THAT(warning(R"(<integrator>densitySampling</integrator><light y="1" r="1"/>)"),
               Catch::Contains("ratioTracking renders it"));
    CHECK_THAT(warning(R"(<integrator scattering="none">ratioTracking</integrator><light y="1" r="1"/>)"),
               Catch::Contains("scatters nothing"));
    CHECK_THAT(warning("<shadowRayDensityMultiplier>4</shadowRayDensityMultiplier>"),
               Catch::Contains("lightRayDensityMultiplier, 1"));
    CHECK_THAT(warning(R"(<emission r="1" multiplier="5"/>)"), Catch::Contains("no temperature grid"));
    CHECK_THAT(warning(R"(<sigma_a>0</sigma_a><medium r="1"/>)"), Catch::Contains("sigma_a is 0"));
    CHECK_THAT(warning("<diffuseRebounds><rebound>5</rebound></diffuseRebounds>"), Catch::Contains("without effect"));
    CHECK_THAT(warning("<fileName>x.png</fileName>"), Catch::Contains("-o"));
    CHECK_THAT(warning("<intersectionHandler>diffuse</intersectionHandler>"), Catch::Contains("<integrator>"));
    CHECK_THAT(warning("<width startOffset=\"3\">640</width>"), Catch::Contains("640 pixels"));
    CHECK_THAT(warning("<sigma_a unit=\"voxel\">1</sigma_a>"), Catch::Contains("world unit"));
    CHECK_THAT(warning(R"(<integrator>deltaTracking</integrator><light y="1" r="1"/>)"),
               Catch::Contains("ratioTracking renders it"));
    CHECK(warns(parse("<sigma_a>1</sigma_a>"), "without effect"));
}

TEST_CASE("a scene that is rendered as asked warns of nothing", "[cpu][xml]") {
    CHECK(parse(R"(<sphere/><width>640</width><height>480</height><importanceSampling>no</importanceSampling>
                   <light x="0" y="0" z="0" r="1" multiplier="0"/><emission r="1" multiplier="0"/><models/>
                   <densityField baseDir=""/><fileName/><integrator/>)")
              .warnings.empty());
}

TEST_CASE("unknown names are errors with the nearest known name", "[cpu][xml]") {
    CHECK(error_of("    <sigma_b>1</sigma_b>") == "s.xml:2:5: unknown element <sigma_b>; did you mean <sigma_a>?");
    CHECK(error_of("<Camera/>") == "s.xml:2:1: unknown element <Camera>; did you mean <camera>?");
    CHECK_THAT(error_of("<sigma_t>1</sigma_t>"), Catch::Contains("unknown element <sigma_t>; extinction is sigma_a"));
    CHECK_THAT(error_of("<phase g=\".5\">rayleigh</phase>"), Catch::Contains("mean cosine is <heyneygreenstein_g>"));
    CHECK_THAT(error_of("<sigma_s>1 2 3</sigma_s>"), Catch::Contains("one for each channel"));
    CHECK_THAT(error_of("<camera lookAt=\"0, 1, 0\"/>"), Catch::Contains("stand spaces, no commas"));
    CHECK_THAT(error_of("<sphere r=\"2\"/>"), Catch::Contains("did you mean radius?"));
    CHECK_THAT(error_of("<zzz/>"), Catch::StartsWith("s.xml:2:1: unknown element <zzz>; known are <densityField>, "));
    CHECK(error_of(R"(<camera x="1" pich="2"/>)") ==
          "s.xml:2:15: unknown attribute 'pich' of <camera>; did you mean pitch?");
    CHECK(error_of(R"(<maxDepth unit="x">3</maxDepth>)") ==
          "s.xml:2:11: unknown attribute 'unit' of <maxDepth>; it has none");
    CHECK(error_of("<camera><x>1</x></camera>") == "s.xml:2:9: unknown element <x>; <camera> has no elements inside");
    CHECK(error_of("<camera>1 2 3</camera>") ==
          "s.xml:2:9: unexpected text '1 2 3' in <camera>; its values are attributes");
    CHECK(error_of("hello") == "s.xml:2:1: unexpected text 'hello' in <options>; its values are elements");
    CHECK(error_of("<filter>\n trilinar</filter>") == "s.xml:3:2: unknown filter 'trilinar'; did you mean trilinear?");
    CHECK(error_of("<integrator>ratiotracking</integrator>") ==
          "s.xml:2:13: unknown integrator 'ratiotracking'; did you mean ratioTracking?");
}

TEST_CASE("values must be what they claim to be", "[cpu][xml]") {
    CHECK(error_of("<sigma_a>thick</sigma_a>") ==
          "s.xml:2:10: <sigma_a> 'thick' is not a number; expected a number >= 0");
    CHECK(error_of("<sigma_a>1.5f</sigma_a>") ==
          "s.xml:2:10: <sigma_a> '1.5f' is not a number; expected a number >= 0");
    CHECK(error_of("<sigma_s>-1</sigma_s>") == "s.xml:2:10: <sigma_s> '-1' is out of range; expected a number >= 0");
    CHECK(error_of("<sigma_s/>") == "s.xml:2:1: <sigma_s> is empty; expected a number >= 0");
    for (const char* value :
         {"nan", "inf", "-inf", "1e999", "0x10", "1,5", "1 2", "--1", "+-1", "+", "-", "1e", "NaN(1)"})
        CHECK_THAT(error_of(std::string("<sigma_s>") + value + "</sigma_s>"),
                   Catch::StartsWith("s.xml:2:10: <sigma_s>"));
    for (const char* value : {"1", "-1", "1.5", "nan"})
        CHECK_THAT(error_of(std::string("<heyneygreenstein_g>") + value + "</heyneygreenstein_g>"),
                   Catch::StartsWith("s.xml:2:21: ") &&
                       Catch::EndsWith("expected a number between -1 and 1, both excluded"));
    CHECK(error_of("<rayPerPixelCount>0</rayPerPixelCount>") == "s.xml:2:19: <rayPerPixelCount> '0' is out of range; "
                                                                "expected a whole number from 1 to 2147483647");
    CHECK_THAT(error_of("<rayPerPixelCount>1.5</rayPerPixelCount>"), Catch::Contains("not a whole number"));
    CHECK_THAT(error_of("<rayPerPixelCount>99999999999999999999</rayPerPixelCount>"), Catch::Contains("out of range"));
    CHECK_THAT(error_of("<maxDepth>-1</maxDepth>"), Catch::Contains("from 0 to"));
    for (const char* value : {"0", "-5", "65537"})
        CHECK_THAT(error_of(std::string("<width>") + value + "</width>"),
                   Catch::StartsWith("s.xml:2:8: ") && Catch::EndsWith("from 1 to 65536"));
    for (const char* value : {"0", "180", "-10", "360"})
        CHECK_THAT(error_of(std::string("<camera fov=\"") + value + "\"/>"),
                   Catch::StartsWith("s.xml:2:9: <camera> fov: ") && Catch::Contains("between 0 and 180"));
    CHECK_THAT(error_of(R"(<light x="0" y="0" z="0" r="1"/>)"),
               Catch::StartsWith("s.xml:2:1: <light> has no direction"));
    CHECK_THAT(error_of(R"(<light y="1" r="-1"/>)"), Catch::StartsWith("s.xml:2:14: <light> r: '-1' is out of range"));
    CHECK_THAT(error_of(R"(<sphere radius="0"/>)"), Catch::StartsWith("s.xml:2:9: <sphere> radius: "));
    CHECK_THAT(error_of(R"(<majorant cell="2.5"/>)"), Catch::StartsWith("s.xml:2:11: <majorant> cell: "));
    CHECK_THAT(error_of(R"(<sigma_a unit="metre">1</sigma_a>)"),
               Catch::StartsWith("s.xml:2:10: ") && Catch::Contains("voxel or world"));
    CHECK_THAT(error_of("<importanceSampling>maybe</importanceSampling>"), Catch::Contains("neither true nor false"));
    CHECK_THAT(error_of(R"(<densityField baseDir="x/"/>)"),
               Catch::StartsWith("s.xml:2:1: <densityField> names no file"));
    CHECK_THAT(error_of("<densityField>a.nvdb</densityField><sigma_a unit=\"world\">1</sigma_a><sigma_s>1</sigma_s>"),
               Catch::Contains("different units"));
}

TEST_CASE("nothing is given twice", "[cpu][xml]") {
    CHECK(error_of("<sigma_a>1</sigma_a>\n  <sigma_a>2</sigma_a>") ==
          "s.xml:3:3: a second <sigma_a>, after the one at s.xml:2:1; remove one");
    CHECK_THAT(error_of("<heyneygreenstein_g>0</heyneygreenstein_g><heynegreenstein_g>0</heynegreenstein_g>"),
               Catch::StartsWith("s.xml:2:43: a second <heynegreenstein_g>"));
    CHECK(error_of(R"(<camera x="1" x="2"/>)") == "s.xml:2:15: attribute x given twice in <camera>; remove one");
    CHECK_THAT(error_of("<sphere/>\n<box/>"), Catch::StartsWith("s.xml:3:1: a <box> beside the <sphere> at s.xml:2:1"));
    CHECK_THAT(error_of("<sphere/>\n<densityField>a.nvdb</densityField>"), Catch::Contains("one shape"));
}

TEST_CASE("malformed XML is located", "[cpu][xml]") {
    CHECK_THAT(error_of_text("<options>\n  <camera></light>\n</options>"),
               Catch::StartsWith("s.xml:2:") && Catch::Contains("malformed XML"));
    CHECK_THAT(error_of_text("<options>"), Catch::Contains("malformed XML"));
    CHECK_THAT(error_of_text(""), Catch::StartsWith("s.xml:1:1: malformed XML: no document element found"));
    CHECK_THAT(error_of_text("<scene/>"), Catch::StartsWith("s.xml:1:1: the root element is <scene>"));
    CHECK_THAT(error_of_text("<options/>\n<options/>"), Catch::StartsWith("s.xml:2:1: a second root element"));
    CHECK_THAT(error_of_text("<!-- \xc3\xa4\xc3\xb6 --><options><x/></options>"), Catch::StartsWith("s.xml:1:21: "));
}

TEST_CASE("garbage never gets further than an InputError", "[cpu][xml]") {
    const std::string seed =
        "<options><camera x=\"1\" fov=\"$f\"/><sigma_a unit='world'>1</sigma_a><sphere/><march step='2'/>"
        "<integrator flight='delta'/><noise gain='.5'/><width startOffset=\"1\" "
        "reference=\"3\">10</width><![CDATA[x]]>&amp;&#0;</options>";
    std::mt19937 random(1);
    for (int i = 0; i < 5000; ++i) {
        std::string text = seed;
        for (int edits = 1 + int(random() % 6); edits > 0 && !text.empty(); --edits) {
            const std::size_t at = random() % text.size();
            switch (random() % 3) {
            case 0:
                text[at] = char(random());
                break;
            case 1:
                text.erase(at, 1 + random() % 8);
                break;
            default:
                text.insert(at, text.substr(random() % text.size(), 1 + random() % 8));
            }
        }
        CHECK_NOTHROW(error_of_text(text, {{"f", "20"}}));
    }
    CHECK_NOTHROW(error_of_text(std::string(100000, '<')));
    std::string deep;
    for (int i = 0; i < 200000; ++i)
        deep += "<options>";
    CHECK_NOTHROW(error_of_text(deep));
    for (int i = 0; i < 200000; ++i)
        deep += "</options>";
    CHECK_THAT(error_of_text(deep), Catch::StartsWith("s.xml:1:10: unknown element <options>"));
}

TEST_CASE("scene files that cannot be read", "[cpu][xml]") {
    CHECK_THROWS_WITH(load_scene("no/such.xml"), "no/such.xml: no such file; name a scene file (.xml)");
    CHECK_THROWS_WITH(load_scene(std::string(VKVOL_SOURCE_DIR) + "/scenes"), Catch::Contains("is a directory"));
    CHECK_THROWS_AS(load_scene("/dev/zero"), InputError);
}

TEST_CASE("places are found in a scene that is one line", "[cpu][xml]") {
    std::string text = "<options><!-- \xc3\xa4 --><surfaces>";
    for (int i = 0; i < 3; ++i)
        text += "<sphere x='" + std::to_string(i) + "'/>";
    const Scene scene = parse_scene(text + "</surfaces><sphere/></options>", "s.xml");
    REQUIRE(scene.surfaces.size() == 3);
    CHECK(scene.surfaces[0].place == "s.xml:1:30");
    CHECK(scene.surfaces[1].place == "s.xml:1:45");
    CHECK(scene.surfaces[2].place == "s.xml:1:60");
    CHECK_THROWS_WITH(parse_scene(text + "<sphere rad='1'/></surfaces></options>", "s.xml"),
                      Catch::StartsWith("s.xml:1:83"));
    // The later of two places is asked for first.
    CHECK_THROWS_WITH(parse_scene("<options><sphere/><box/></options>", "s.xml"),
                      Catch::StartsWith("s.xml:1:19") && Catch::Contains("s.xml:1:10"));
}

TEST_CASE("an attribute that is not there has its element's place", "[cpu][xml]") {
    CHECK_THAT(error_of("<lights>\n <daylight x='1'/></lights>"), Catch::StartsWith("s.xml:3:2: "));
    CHECK_THAT(error_of("<lights>\n <sun y='1' multiplier='1e9'/></lights>"), Catch::StartsWith("s.xml:3:2: "));
}

TEST_CASE("what is in no volume is said", "[cpu][xml]") {
    const std::string volumes = "<volumes><volume><box/></volume></volumes>";
    const Scene scene = parse("<sigma_s>4</sigma_s>" + volumes);
    CHECK(scene.volumes.size() == 1);
    CHECK(warns(scene, "it is in no volume"));
    for (const char* element : {"<layers scaleHeight='1'/>", "<transferFunction/>", "<emission r='1'/>",
                                "<phase>x</phase>", "<lightRayDensityMultiplier>2</lightRayDensityMultiplier>"}) {
        CAPTURE(element);
        CHECK(warns(parse(element + volumes), "it is in no volume"));
    }
    CHECK(parse("<models/><densityField baseDir=''/>" + volumes).warnings.empty());
}

TEST_CASE("what is without effect has numbers all the same", "[cpu][xml]") {
    CHECK_THAT(error_of("<sphere/><light x='abc'/>"), Catch::Contains("not a number"));
    CHECK_THAT(error_of("<sphere/><light x='1' zenith='9'/>"), Catch::Contains("say the direction already"));
    CHECK_THAT(error_of("<sphere/><light group='a b'/>"), Catch::Contains("group"));
    CHECK(parse("<sphere/><light multiplier='0'/>").lights.empty());
    CHECK_THAT(error_of("<sphere/><camera focus='abc'/>"), Catch::Contains("not a number"));
    CHECK_THAT(error_of("<sphere/><camera blades='2'/>"), Catch::Contains("fewer than three"));
    CHECK_THAT(error_of("<sphere/><lights><point value='1'/></lights>"), !Catch::Contains("between the tags"));
    CHECK_THAT(error_of("<sphere/><sigma_a value='1'/>"), Catch::Contains("between the tags"));
}

TEST_CASE("text beside the root element is an error", "[cpu][xml]") {
    CHECK_THAT(error_of_text("<options/> <!-- --> rayPerPixelCount=64"),
               Catch::StartsWith("s.xml:1:21: stray text 'rayPerPixelCount=64'"));
    CHECK_THAT(error_of_text("\n  x<options/>"), Catch::StartsWith("s.xml:2:"));
    CHECK_NOTHROW(parse_scene("<?xml version='1.0'?>\n<!-- a -->\n<options/>\n<!-- b -->\n\n", "s.xml"));
}

TEST_CASE("remedies of others' words work", "[cpu][xml]") {
    CHECK_THAT(error_of("<sphere/><to_world/>"), Catch::Contains("a <volume> of <volumes>"));
    CHECK_THAT(error_of("<surfaces><sphere radiance=\"5\"/></surfaces>"), Catch::Contains("<emission r="));
    CHECK_THAT(error_of("<sigma_s>1,5</sigma_s>"), Catch::Contains("a decimal point is no comma"));
    CHECK_THAT(error_of("<surfaces><plane checker=\".1\" repeat=\"\"/></surfaces>"),
               Catch::Contains("repeat: is empty"));
    // The element whose lights are left out, and not one that is black.
    const Scene scene = parse_scene("<options><light y=\"1\"/>\n<lights><point r=\"1\" g=\"1\" b=\"1\"/></lights>\n"
                                    "<sphere/><integrator>deltaTracking</integrator></options>",
                                    "s.xml");
    REQUIRE(scene.warnings.size() == 1);
    CHECK_THAT(scene.warnings.front(), Catch::StartsWith("s.xml:2:1: deltaTracking sends no shadow rays"));
}

TEST_CASE("models that ask for nothing leave those of a volume that is liked", "[cpu][xml]") {
    const Scene scene = parse_scene(
        "<options><volumes><volume name=\"a\"><models><model>b.obj</model></models><sigma_s>1</sigma_s></volume>"
        "<volume like=\"a\"><models/></volume></volumes></options>",
        "s.xml");
    REQUIRE(scene.volumes.size() == 2);
    CHECK(std::get<MeshFiles>(scene.volumes[1].shape).paths == std::get<MeshFiles>(scene.volumes[0].shape).paths);
}

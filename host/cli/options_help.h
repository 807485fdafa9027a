// The prose of the command line's help.
#pragma once

namespace vkvol {

inline constexpr const char* render_description =
    "Renders participating media: clouds, smoke, fog. On any Vulkan device that `vkvol devices` calls usable.";

inline constexpr const char* render_footer = R"(Other commands (each has its own --help):
  vkvol devices               the Vulkan devices of this machine
  vkvol info FILE.nvdb        what is in a density file, with a camera and coefficients that suit it
  vkvol integrators           the estimators there are, by name, and which of them are biased
  vkvol compare A.exr B.exr   are these renders of the same picture?
  vkvol merge A.exr B.exr -o OUT.exr   one image of all their samples
  vkvol develop A.exr -o B.png   a PNG of another exposure or tone curve, without rendering
  vkvol convert S.pbrt -o S.xml  a scene of pbrt-v4 as a scene file to go on from
  vkvol init                  a scene file to start from: scene.xml, or of a density file that is named
  vkvol measure SCENE.xml     its readings with their standard errors as a table, of many values of $keys
  vkvol view SCENE.xml        on a page of the browser, to turn, light and change it while it is rendered
  vkvol bench SCENE.xml       error against time of the integrators that suit a scene
  vkvol demo                  a cloud, to see that all is well: cumulus.exr and cumulus.png here

Examples:
  vkvol scenes/cumulus.xml                         writes cumulus.exr and cumulus.png here
  vkvol cloud.nvdb                                 a picture of a density file, and a scene to start from
  vkvol cloud.xml --width 480 --spp 4 -o look.png  a quick look
  vkvol cloud.xml --time 5m -o cloud.exr           the best picture of five minutes
  vkvol cloud.xml --noise 1% -o cloud.exr          as many samples as that takes
  vkvol cloud.xml --spp 64 --sample-offset 64 -o part2.exr   samples 64 to 127, for merge
  vkvol sweep.xml -D g=0.8 -o g0.8.exr             fills $g in the scene
  vkvol turntable.xml -f 1..8 -o turn.####.png     eight frames: $F in the scene is 1, 2, ... 8
  vkvol cloud.xml --dry-run                        is all well? what would be rendered?
  vkvol cloud.xml --spp 4096 --checkpoint 60s --resume   may be killed at any time, and started again
  vkvol cloud.xml --pixel 12,34 --sample 7 --trace       where that path went

Exit codes: 0 done; 1 the render failed; 2 bad command line, scene or asset; 3 no usable device;
4 compare found a difference; 5 something was cut short, dropped or
cleaned, under --strict; 130 interrupted (what was rendered so far is written).)";

inline constexpr const char* demo_description =
    "Renders the cloud that comes with the program, to see that all is well: cumulus.exr and cumulus.png here.";

inline constexpr const char* demo_footer =
    R"(It is scenes/cumulus.xml with --tonemap aces; all options of a render change that.

Examples:
  vkvol demo
  vkvol demo --width 320 --spp 16 -o look.png)";

inline constexpr const char* integrators_description =
    "Lists the integrators: which estimators each combines, whether it is unbiased, and where it comes from.";

inline constexpr const char* compare_description =
    "Compares two renders: error figures, and whether noise alone explains the difference.";

inline constexpr const char* compare_footer =
    R"(Images with variance are judged by statistics: no pixel may differ by more standard errors than the
most extreme of that many equal pixels would, nor may the picture means. Images without variance must
be equal. The statistics take the images for independent: give each its own --seed. A note on standard
error says where images share samples, or are of different scenes; identical ones need none.
Exit codes: 0 the same; 4 different; 2 the images cannot be compared.)";

inline constexpr const char* merge_description =
    "Merges renders of one picture: disjoint sample ranges or seeds of the same window, weighted by samples per "
    "pixel, or disjoint windows side by side.";

inline constexpr const char* merge_footer =
    R"(Images of different scenes or integrators are refused, and images that share samples: each run needs its
own --seed or --sample-offset. Pixels that no image holds are black, and a warning says how many. The
merged image adds up what its parts count, is biased if one of them is, and can be merged again.)";

inline constexpr const char* develop_description =
    "Makes an 8-bit picture of an image's linear radiance, without rendering: with the tone curve and exposure of the "
    "render that wrote it, or with others.";

inline constexpr const char* convert_description =
    "Writes a scene of pbrt-v4 as a scene file of this renderer, and says what of it cannot be rendered.";

inline constexpr const char* convert_footer =
    R"(vkvol SCENE.pbrt renders one without writing it. Names of files are written as the new scene finds
them; grids, meshes and images stay where they are, and grids that stand in the scene, and clouds,
are written beside the new one.)";

inline constexpr const char* init_description =
    "Writes a scene file to start from: smoke above the ground, with a word on each element; or what suits a density "
    "file.";

inline constexpr const char* init_footer = R"(A file that is there already is never written over.

Examples:
  vkvol init                          writes scene.xml
  vkvol init smoke.vdb --up z         writes smoke.xml: its view, light and coefficients suit the smoke)";

inline constexpr const char* measure_description = "Renders a scene and prints its pixels, or what its sensors of flux "
                                                   "read, with standard errors; for each of many values of its "
                                                   "$keys.";

inline constexpr const char* measure_footer =
    R"(Combinations of values follow one another, the last key fastest, with the same random numbers: what
they differ by has less noise than they have. Standard errors are of each row by itself.

Examples:
  vkvol measure slab.xml                                   one row for each pixel, or point
  vkvol measure slab.xml -D sun=0.1,0.5,1 --noise 0.1% -o fluxes.csv
  vkvol measure slab.xml -D depth=0..10x21 --mean          a row for each depth)";

inline constexpr const char* view_description =
    "Shows a scene on a page of the browser while it is rendered: turn the camera, change the lights, the medium and "
    "the integrator, and keep the picture or the scene.";

inline constexpr const char* view_footer =
    R"(Prints the page's address, which has a key: nobody else can look, and nothing listens but on this machine. The
scene's file may be edited meanwhile: the page follows. Nothing is written but what the page's reader keeps. A
scene that is kept has what the page changed, and not what -D, --grid, --width and --height did.

Example:
  vkvol view scenes/cumulus.xml --width 640)";

inline constexpr const char* develop_footer =
    R"(Without options the picture has the same bytes as the one that the render wrote, or would have. An image
that does not tell how it was rendered gets curve srgb and exposure 0.

Curves: srgb keeps values up to 1 as they are and cuts what is brighter, which turns fire yellow and white;
agx and aces lead bright colours towards white by and by; reinhard, the original renderer's, makes the
brightest value white.

Example:
  vkvol develop fire.exr -o fire.png --exposure -1 --tonemap agx)";

inline constexpr const char* bench_description = "Measures integrators on a scene, error against time: relMSE at 1, 2, "
                                                 "4, ... samples per pixel against a reference.";

inline constexpr const char* bench_footer =
    R"(Writes NAME.bench.json, NAME.bench.csv and each integrator's last picture, NAME.bench/INTEGRATOR.exr.
All integrators must estimate the same picture; biased ones are measured when named. A reference is
rendered first, for half of the time again or more, and kept in the user's cache directory. With that and
with setting up, a bench takes longer than --time: how long is printed before it begins.

Example:
  vkvol bench cloud.xml --width 120 --integrators ratioTracking,ratioTracking:flight=weighted --time 2m)";

} // namespace vkvol

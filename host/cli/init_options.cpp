#include "init_options.h"

#include "option_groups.h"
#include "option_values.h"
#include "options_help.h"

namespace vkvol {

void parse_init(const std::vector<std::string>& arguments, Options& options) {
    InitOptions& init = options.init;
    CLI::App app(init_description, "vkvol init");
    std::string up;
    app.add_option("grid", init.grid, "A density file to begin with")->option_text("[FILE.nvdb|FILE.vdb]");
    app.add_option("-o,--output", init.output, "Where to write")
        ->option_text("FILE.xml [scene.xml, or the density file's name]");
    app.add_option("--up", up, "Of the density file: y, or z as Blender has it")->option_text("y|z [y]");
    app.add_flag("-q,--quiet", init.quiet, "Print errors only");
    app.footer(init_footer);
    if (!run_parser(app, arguments, options))
        return;
    if (!up.empty())
        init.up = choose<Up>("--up", up, {{"y", Up::y}, {"z", Up::z}});
}

} // namespace vkvol

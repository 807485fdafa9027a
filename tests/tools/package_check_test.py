#!/usr/bin/env python3
"""Tests of tools/check_packages.py: what it reads from scripts and from dpkg, and that it names what is not listed."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from package_check import script_use  # noqa: E402
from package_check.debian import Packages  # noqa: E402
from package_check.shell_commands import Script  # noqa: E402


class ShellScripts(unittest.TestCase):
    def called(self, text, *programs):
        self.assertEqual(Script(text).programs(), set(programs), text)

    def test_commands_stand_where_a_command_can_stand(self):
        self.called("cmake --build grep; sed x | awk y && cut z || tr\nexec uniq", "cmake", "sed", "awk", "cut", "tr", "uniq")
        self.called("if ! cmp a b; then ls; elif diff; then rm; else mv; fi", "cmp", "ls", "diff", "rm", "mv")
        self.called("while id; do tac; done <file >out 2>&1; ( nl ) & { od; }", "id", "tac", "nl", "od")
        self.called("for cat in dog; do sleep 1; done; for ((i = 0; i < 3; ++i)); do seq 1; done", "sleep", "seq")
        self.called("[ -f file ] || [[ tail > head ]] && x=$((sort + 1)) echo join", )
        self.called("(( n > 1 )) && wc -l \\\n grep", "wc")

    def test_comments_quotes_and_documents_call_nothing(self):
        self.called("# rm it\nls '| rm' \"; rm\" a#rm \\; rm", "ls")
        self.called("cat <<'END' | tr a b\nrm it's\nEND\nls", "cat", "tr", "ls")
        self.called("read x <<<\"$y rm\"\nls", "ls")

    def test_substitutions_do(self):
        self.called('x="a $(dirname "$(readlink y)") b" z=`uname`', "dirname", "readlink", "uname")
        self.called('echo "${x:-$(pwd2)}" "$((1 + 2))" <(sort a)', "pwd2", "sort")

    def test_cases_have_patterns(self):
        self.called('case $1 in\n rm | "mv") ls ;;\n *) cat; df ;;\nesac; du', "ls", "cat", "df", "du")
        self.called("case x in a) tr ;; b) wc\nesac\nls", "tr", "wc", "ls")

    def test_programs_that_run_another(self):
        self.called("find . -print0 | xargs -0 -n 1 xmllint --noout", "find", "xargs", "xmllint")
        self.called("A=1 env -i B=2 timeout 10s nice ./x; command -v sudo; sh -c 'mount -t tmpfs x /mnt'", "env", "timeout", "nice", "sh", "sudo", "mount")
        self.called('private=(unshare --mount); list=(rm mv); "${private[@]}" sh -c "mount x"; ls "${list[@]}"',
                    "unshare", "sh", "mount", "ls")
        self.called("trap 'rmdir \"$x\"' EXIT", "rmdir")

    def test_functions_are_no_programs(self):
        self.called("say() { printf x; }\nclean() (\n rm y\n)\nsay; clean; \"$build/vkvol\" compare", "rm")


class PythonScripts(unittest.TestCase):
    def test_programs_and_modules(self):
        text = ("#!/usr/bin/env python3\nimport os, numpy.linalg\nfrom PIL import Image\nfrom . import near\nimport own\n"
                "subprocess.run(['mount', x])\nsubprocess.run([program, 'rm'])\nRun(lab, wrap=['prlimit', 'x'])\n")
        scripts = {Path("tools/a"): text, Path("tools/own.py"): "def f():\n    import scipy\n"}
        self.assertEqual(set(script_use.programs_called(scripts)), {"python3", "mount", "prlimit"})
        self.assertEqual(set(script_use.modules_imported(scripts)), {"numpy", "PIL", "scipy"})


class DebianPackages(unittest.TestCase):
    def packages(self, **depends):
        return Packages([f"{name}\t, {text}\t{'virtual (= 1)' if name == 'real' else ''}\t{'yes' if name == 'base' else 'no'}\toptional"
                         for name, text in depends.items()])

    def test_dependencies_are_followed(self):
        all_ = self.packages(base="", a="b (>= 1), c:any", b="virtual", c="", real="", chance="")
        self.assertEqual(all_.closure(["a"]), {"base", "a", "b", "c", "real"})

    def test_of_alternatives_the_first_counts(self):
        all_ = self.packages(a="gone | b | chance", b="a", chance="")
        self.assertEqual(all_.closure(["a"]), {"a", "b"})


class OtherSystems(unittest.TestCase):
    def test_without_dpkg_the_whole_list_is_named_and_what_to_run(self):
        with tempfile.TemporaryDirectory() as folder:
            for program in ("bash", "basename", "dirname", "fmt", "sed"):
                os.symlink(shutil.which(program), os.path.join(folder, program))
            done = subprocess.run([ROOT / "tools" / "demo.sh"], env={"PATH": folder}, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("packages cannot be installed", done.stderr)
        self.assertIn("tested on Debian 12 and 13", done.stderr)
        for needed in ("libtinyobjloader-dev", "catch2", "cmake --preset release && cmake --build --preset release"):
            self.assertIn(needed, done.stderr)


# On the build that the tests belong to.
class WholeCheck(unittest.TestCase):
    def check(self, *arguments):
        done = subprocess.run([sys.executable, ROOT / "tools" / "check_packages.py", os.environ["VKVOL_BUILD"], *arguments],
                              capture_output=True, text=True)
        if done.returncode == 77:
            self.skipTest(done.stdout)
        return done

    @unittest.skipUnless("VKVOL_BUILD" in os.environ, "VKVOL_BUILD names no build")
    def test_a_package_that_is_not_listed_is_named_with_what_it_was_used_for(self):
        done = self.check("--without", "libtinyobjloader-dev")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"libtinyobjloader-dev\S* is not listed in tools/setup.sh, but used: /usr/include/tiny_obj_loader.h \(header")
        done = self.check("--without", "libxml2-utils", "--without", "python3-matplotlib")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"libxml2-utils\S* is not listed in tools/setup.sh, but used: /usr/bin/xmllint \(program, called by tools/test.sh")
        self.assertRegex(done.stdout, r"python3-matplotlib\S* is not listed .*\(module, imported by tools/thesis_")


if __name__ == "__main__":
    unittest.main()

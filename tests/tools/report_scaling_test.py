"""tools/scaling.py: scenes that it changes name the same files from wherever they are."""
import pathlib
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree as xml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import scaling  # noqa: E402

SCENE = r"""<options>
  <volumes><volume><densityField baseDir="fields\">smoke.nvdb</densityField><table file="drops.txt"/></volume></volumes>
  <surfaces><rectangle texture="wood.png"/><mesh file="a.ply" baseDir="meshes" texture="../b.png"/></surfaces>
  <lights><sky baseDir="..">noon.hdr</sky><sky turbidity="3"/></lights>
  <absorption width="1"/>
</options>"""


class ScalingTest(unittest.TestCase):
    def test_changed_scenes_find_their_files(self):
        with tempfile.TemporaryDirectory() as folder:
            here = pathlib.Path(folder).resolve() / "scenes"
            here.mkdir()
            (here / "a.xml").write_text(SCENE)
            chosen = types.SimpleNamespace(build="build", scene=here / "a.xml")
            changed = scaling.Bench(chosen, folder).changed_scene("b", lambda root: scaling.set_element(root, "maxDepth", 4))
            root = xml.parse(changed).getroot()

            def file(path, attribute=None):
                node = root.find(path)
                name = pathlib.Path(node.get(attribute) if attribute else node.text)
                self.assertTrue(name.is_absolute())
                return name.resolve().relative_to(here.parent).as_posix()

            self.assertEqual(file(".//densityField"), "scenes/fields/smoke.nvdb")
            self.assertEqual(file(".//table", "file"), "scenes/drops.txt")
            self.assertEqual(file(".//rectangle", "texture"), "scenes/wood.png")
            self.assertEqual(file(".//mesh", "file"), "scenes/meshes/a.ply")
            self.assertEqual(file(".//mesh", "texture"), "scenes/b.png")
            self.assertEqual(file(".//sky"), "noon.hdr")
            self.assertFalse(root.findall(".//*[@baseDir]"))
            self.assertIsNone(root.findall(".//sky")[1].text)
            self.assertEqual(root.find("maxDepth").text, "4")


if __name__ == "__main__":
    unittest.main()

"""Molecules: one of several states, with bonds between its own atoms alone."""

import numpy as np
import pytest
from refusals import read_warned, refused, refused_files, saved

import vizlight
from vizlight.mesh import meaning
from vizlight.reading import molecules

pytestmark = pytest.mark.usefixtures("without_trial")

ATOM = "ATOM  {:5d}  CA  GLY A{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           C  \n"
WATER = "3\nwater\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n"


def written(folder, text, name):
    return saved(folder / name, text)


def test_the_first_of_several_models_is_read(tmp_path):
    atoms = [ATOM.format(i + 1, i + 1, 1.5 * i, 0, 0) for i in range(4)]
    one = vizlight.read(written(tmp_path, "".join(atoms) + "END\n", "one.pdb"))
    models = "".join(f"MODEL     {k}\n{''.join(atoms)}ENDMDL\n" for k in (1, 2, 3))
    states = f"{''.join(atoms)}END\n" * 3
    for text in (f"{models}END\n", states):
        with pytest.warns(UserWarning, match="the first of 3 states of a molecule is read"):
            first = vizlight.read(written(tmp_path, text, "three.pdb"))
        assert first.n_points == one.n_points == 4
        assert first.n_lines == one.n_lines == 3
        np.testing.assert_array_equal(first.points, one.points)
    # A ligand behind a chain is no other state.
    both = f"{''.join(atoms)}END\n{ATOM.format(9, 9, 9, 9, 9)}END\n"
    assert vizlight.read(written(tmp_path, both, "both.pdb")).n_points == 5


def test_elements_are_those_of_the_columns_or_of_the_names(tmp_path):
    """Old files have other words in the columns of elements; hydrogen is kept."""
    names = [(" CA ", "ATOM  "), ("HG1 ", "ATOM  "), ("FE  ", "HETATM"), ("1HB ", "ATOM  ")]
    lines = [
        f"{kind}{i + 1:5d} {name} GLY A{i + 1:4d}    {9.0 * i:8.3f}{0:8.3f}{0:8.3f}  0.50 {i:5.2f}"
        for i, (name, kind) in enumerate(names)
    ]
    for end in ("      1HPV 186", ""):
        mesh = vizlight.read(written(tmp_path, "".join(f"{one}{end}\n" for one in lines), "a.pdb"))
        assert mesh["atom_type"].tolist() == [6, 1, 26, 1]
        assert (mesh.n_lines, mesh.n_verts) == (0, 4)
    assert mesh["b_factor"].tolist() == [0, 1, 2, 3]
    assert mesh["residue"].tolist() == [1, 2, 3, 4]
    assert mesh["occupancy"].tolist() == [0.5] * 4


def test_places_may_lack_the_zero_before_the_point(tmp_path):
    line = ATOM.format(1, 1, 0.5, 3, -0.25).replace(" 0.500", "  .500").replace("-0.250", " -.250")
    mesh = vizlight.read(written(tmp_path, line, "a.pdb"))
    np.testing.assert_array_equal(mesh.points, [[0.5, 3, -0.25]])


def test_atoms_of_xyz_are_joined_by_their_distances(tmp_path):
    water = vizlight.read(written(tmp_path, WATER, "water.xyz"))
    assert water["atom_type"].tolist() == [8, 1, 1]
    assert sorted(map(sorted, water.lines.reshape(-1, 3)[:, 1:].tolist())) == [[0, 1], [0, 2]]
    assert water.n_verts == 0
    assert meaning.flags(water, "atom_type") == {1: "H", 8: "O"}
    assert meaning.flags(water, "atom_type", "colors") == {1: "#e6e6e6", 8: "#ff0d0d"}
    far = WATER.replace("3", "4", 1) + "Na1 9 9 9\n"
    salt = read_warned(written(tmp_path, far + far, "salt.xyz"), "the first of 2 states")
    assert (salt.n_points, salt.n_lines, salt.n_verts) == (4, 2, 1)
    assert salt["atom_type"][3] == 11


test_damaged_molecules_are_refused = refused_files(
    lambda folder, text: vizlight.read(written(folder, text, "water.xyz")),
    (WATER.replace("3", "5", 1), "3 of 5 atoms are there"),
    (WATER.replace("H 0.96", "Qq 0.96"), "line 4 has no element"),
    (WATER.replace("0.96", "x"), "line 4 has no element"),
    (WATER.replace("0.96", "nan"), "line 4 has no element"),
)


def test_water_beside_a_molecule_is_left_out_of_its_picture(tmp_path):
    atoms = [ATOM.format(i + 1, 1, 1.5 * i, 0, 0) for i in range(4)]
    water = "HETATM   99  O   HOH A  99       9.000   9.000   9.000  1.00  0.00           O  \n"
    look = vizlight.look(written(tmp_path, "".join([*atoms, water]), "a.pdb"))
    assert look.drawing.notes == ["left out: HOH (1 atoms)"]
    assert look.drawing.layers[0].mesh.run().bounds[3] < 5
    alone = vizlight.look(written(tmp_path, water, "b.pdb"))
    assert alone.drawing.notes == []


def test_points_without_elements_stay_a_scan(tmp_path):
    scan = vizlight.read(written(tmp_path, "0 0 0\n1 0 0\n0 1 0\n", "scan.xyz"))
    assert (scan.n_points, scan.n_lines) == (3, 0)


def helix(count, chain):
    """Return the lines of a chain of carbons 3.8 angstroms apart, with waters around them."""
    turn = 100 * np.pi / 180 * np.arange(count)
    places = np.column_stack([2.3 * np.cos(turn), 2.3 * np.sin(turn), 1.5 * np.arange(count)])
    places[:, 0] += 20 * "AB".index(chain)
    return [
        ATOM.format(i + 1, i + 1, *place).replace(" A", f" {chain}", 1)
        for i, place in enumerate(places.tolist())
    ]


def test_a_backbone_is_one_closed_surface_for_each_piece_of_a_chain(tmp_path):
    water = "HETATM   99  O   HOH A  99       9.000   9.000   9.000  1.00  0.00           O  \n"
    lines = [*helix(40, "A"), water, *helix(40, "B")]
    mesh = vizlight.read(written(tmp_path, "".join(lines), "two.pdb"))
    assert mesh.active_scalars_name == "chain"
    assert meaning.flags(mesh, "chain") == {0: "A", 1: "B"}
    assert np.count_nonzero(mesh["backbone_mask"]) == 80
    solid = molecules.backbone(mesh)
    assert (solid.is_manifold, {*solid["chain"]}) == (True, {0, 1})
    assert pieces(solid) == 2
    assert solid["residue"].min() == 1
    assert solid["residue"].max() == 40
    # Beside the ends, a ribbon through points of a helix has its radius.
    inner = (solid["chain"] == 0) & (solid["residue"] > 3) & (solid["residue"] < 37)
    np.testing.assert_allclose(np.hypot(*solid.points[inner, :2].T), 2.3, atol=0.45)
    del lines[20:23]
    gap = molecules.backbone(vizlight.read(written(tmp_path, "".join(lines), "gap.pdb")))
    assert pieces(gap) == 3
    assert gap.is_manifold
    assert not np.isin([21, 22, 23], gap["residue"][gap["chain"] == 0]).any()
    one = vizlight.read(written(tmp_path, "".join(helix(70, "A")), "one.pdb"))
    assert one.active_scalars_name == "residue"


@pytest.mark.parametrize(("count", "element", "long"), [
    (24, "C", False), (25, "C", True), (59, "P", False), (60, "P", True),
])  # fmt: skip
def test_a_small_protein_has_a_fold_and_a_short_nucleic_acid_has_bases(
    count, element, long, tmp_path
):
    lines = "".join(helix(count, "A"))
    if element == "P":
        lines = lines.replace(" CA ", " P  ").replace("GLY", " DG").replace(" C  ", " P  ")
    mesh = vizlight.read(written(tmp_path, lines, "small.pdb"))
    assert np.count_nonzero(mesh["backbone_mask"]) == count
    assert molecules.is_polymer(mesh) is long


def pieces(surface):
    return len({*surface.connectivity()["RegionId"]})


HELIX = "HELIX    1   1 GLY A   11  GLY A   20  1                                  10    \n"
SHEET = "SHEET    1   A 1 GLY A  25  GLY A  30  0 \n"


def test_records_of_a_file_tell_its_helices_and_strands(tmp_path):
    """They count even where the places would tell another kind."""
    path = written(tmp_path, HELIX + SHEET + "".join([*helix(40, "A"), *helix(9, "B")]), "a.pdb")
    atoms = vizlight.read(path)
    kinds = np.zeros(49)
    kinds[10:20], kinds[24:30] = 1, 2
    np.testing.assert_array_equal(atoms["secondary_structure"], kinds)
    flags = {0: "loop", 1: "helix", 2: "strand"}
    assert meaning.flags(atoms, "secondary_structure") == flags
    solid = molecules.backbone(atoms)
    axis = solid.points[:, 2] - 1.5 * (solid["residue"] - 1)
    wide = [np.abs(axis[(solid["residue"] == i) & (solid["chain"] == 0)]).max() for i in (5, 15)]
    assert wide[0] < 1.2 < wide[1]


@pytest.mark.parametrize(
    ("compound", "name"),
    [
        ("COMPND    UBIQUITIN\n", "Ubiquitin"),
        ("COMPND    MOL_ID: 1;\nCOMPND   2 MOLECULE: HIV-1 PROTEASE;\n", "HIV-1 protease"),
        ("COMPND    MOL_ID: 1;\nCOMPND   2 MOLECULE: A;\nCOMPND   3 MOLECULE: B;\n", "a"),
    ],
)
def test_a_chain_has_the_name_of_its_molecule_and_the_colors_of_its_fold(compound, name, tmp_path):
    path = written(tmp_path, compound + HELIX + "".join(helix(80, "A")), "a.pdb")
    look = vizlight.look(path)
    assert look.array == "secondary_structure"
    assert look.key[0]["title"] == f"{name}, secondary_structure"


def test_records_of_cif_are_those_of_pdb(tmp_path):
    gemmi = pytest.importorskip("gemmi")
    path = written(tmp_path, HELIX + SHEET + "".join(helix(40, "A")), "a.pdb")
    gemmi.read_pdb(str(path)).make_mmcif_document().write_file(str(tmp_path / "a.cif"))
    of_pdb, of_cif = vizlight.read(path), vizlight.read(tmp_path / "a.cif")
    for name in ("a.pdbx", "a.mmcif"):
        assert vizlight.read(saved(tmp_path / name, (tmp_path / "a.cif").read_bytes())) == of_cif
    assert of_pdb["secondary_structure"].max() == 2
    np.testing.assert_array_equal(of_cif["secondary_structure"], of_pdb["secondary_structure"])


def test_the_oxygen_of_a_peptide_is_marked_and_that_of_water_is_not(tmp_path):
    def atom(name, x, residue):
        line = ATOM.format(1, residue, x, 0, 0)
        return line.replace(" CA ", f" {name:3}").replace("           C ", f"           {name[0]} ")

    rows = [("CA", 0, 1), ("O", 2.4, 1), ("CA", 3.8, 2), ("O", 9, 2), ("O", 2.3, 3)]
    mesh = vizlight.read(written(tmp_path, "".join(atom(*row) for row in rows), "a.pdb"))
    assert mesh["backbone_mask"].tolist() == [1, 2, 1, 0, 2]


def test_an_alpha_carbon_may_begin_where_calcium_does(tmp_path):
    """CHARMM writes all names at the left edge of their columns."""
    lines = helix(70, "A")
    shifted = [line.replace("  CA  GLY", " CA   GLY") for line in lines]
    whole, left = (
        vizlight.read(written(tmp_path, "".join(rows), "a.pdb")) for rows in (lines, shifted)
    )
    assert shifted != lines
    np.testing.assert_array_equal(left["backbone_mask"], whole["backbone_mask"])
    assert left["backbone_mask"].all()
    ion = "HETATM   99 CA    CA A  99       9.000   9.000   9.000  1.00  0.00          CA  \n"
    assert vizlight.read(written(tmp_path, ion, "ion.pdb"))["backbone_mask"].tolist() == [0]


def hetero(name, residue, number, place, element):
    line = "HETATM{:5d} {:4} {:3} A{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00          {:>2}  \n"
    return line.format(number, name, residue, number, *place, element)


def test_ligands_are_what_is_in_no_chain_without_water(tmp_path):
    odd = [*helix(70, "A")]
    # A modified amino acid has a carbon of the backbone.
    odd[4] = odd[4].replace("ATOM  ", "HETATM").replace("GLY", "CSO")
    beside = [
        hetero(" C1 ", "LIG", 101, (20, 0, 0), "C"), hetero(" C2 ", "LIG", 101, (21.4, 0, 0), "C"),
        hetero("MG  ", "MG", 102, (30, 0, 0), "MG"), hetero(" O  ", "HOH", 103, (40, 0, 0), "O"),
    ]  # fmt: skip
    atoms = vizlight.read(written(tmp_path, "".join(odd + beside), "a.pdb"))
    assert molecules.beside_chains(atoms) == {"HOH": 1, "LIG": 2, "MG": 1}
    ligands = molecules.ligands(atoms)
    assert ligands["atom_type"].tolist() == [6, 6, 12]
    assert (ligands.n_lines, ligands.n_verts) == (1, 1)
    np.testing.assert_allclose(ligands.points[:, 0], [20, 21.4, 30])
    # As many as lipids have would hide the chains.
    crowd = [hetero(" C1 ", "POP", 200, (9 * i, 90, 0), "C") for i in range(99)] * 11
    atoms = vizlight.read(written(tmp_path, "".join(odd + beside + crowd), "a.pdb"))
    assert molecules.beside_chains(atoms)["POP"] == 1089
    assert molecules.ligands(atoms).n_points == 3
    assert molecules.ligands(vizlight.read(written(tmp_path, WATER, "w.xyz"))).n_points == 0


def test_the_phosphate_of_a_lipid_is_no_nucleotide(tmp_path):
    def masks(residue, *atoms):
        lines = [hetero(name, residue, 1, (i, 0, 0), name[1]) for i, name in enumerate(atoms)]
        return vizlight.read(written(tmp_path, "".join(lines), "a.pdb"))["backbone_mask"].sum()

    assert masks("DPP", " P  ", " C3 ") == 0
    assert masks("PSU", " P  ", " C3'") == masks(" DA", " P  ") == 1


def test_water_is_left_out_of_a_crowd_of_molecules(tmp_path):
    lipids = [hetero(" C1 ", "LIP", i // 2, (1.4 * i, 0, 0), "C") for i in range(3000)]
    water = [hetero(" O  ", "HOH", i, (1.4 * i, 9, 0), "O") for i in range(3000)]
    look = vizlight.look(written(tmp_path, "".join(lipids + water), "a.pdb"))
    assert "left out: HOH (3000 atoms)" in look.drawing.notes
    assert look.drawing.layers[0].mesh.run().bounds[3] == 0


def test_a_backbone_needs_a_molecule_of_residues(tmp_path):
    water = vizlight.read(written(tmp_path, WATER, "water.xyz"))
    with pytest.raises(ValueError, match="atoms: expected a molecule of a PDB or CIF file"):
        molecules.backbone(water)
    with pytest.raises(TypeError, match="atoms: expected a pyvista.PolyData"):
        molecules.backbone("1abc.pdb")
    text = "".join(ATOM.format(i + 1, i + 1, 9.0 * i, 0, 0) for i in range(70))
    apart = vizlight.read(written(tmp_path, text, "apart.pdb"))
    assert molecules.backbone(apart).n_points == 0
    assert vizlight.look(apart).mesh.n_points == 70


CRYSTAL = """data_salt
_cell_length_a 4
_cell_length_b 4
_cell_length_c 4
_cell_angle_alpha 90
_cell_angle_beta 90
_cell_angle_gamma 90
_space_group_name_H-M_alt 'P m -3 m'
loop_
_atom_site_label
_atom_site_type_symbol
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
_atom_site_occupancy
"""


def test_a_crystal_has_its_atoms_in_all_places_of_its_cell(tmp_path):
    """A caesium on the corner is on eight, a chlorine in the middle on one."""
    pytest.importorskip("gemmi")
    text = f"{CRYSTAL}Rb1 Rb 0 0 0 0.1\nCs1 Cs 0 0 0 0.9\nCl1 Cl 0.5 0.5 0.5 1\n"
    mesh = vizlight.read(written(tmp_path, text, "salt.cif"))
    assert sorted(mesh["atom_type"].tolist()) == [17] + 8 * [55]
    corners = mesh.points[mesh["atom_type"] == 55]
    assert sorted(map(tuple, corners.tolist())) == [
        (x, y, z) for x in (0, 4) for y in (0, 4) for z in (0, 4)
    ]
    np.testing.assert_allclose(mesh.points[mesh["atom_type"] == 17], [[2, 2, 2]])
    np.testing.assert_allclose(mesh.field_data["unit_cell"], 4 * np.eye(3), atol=1e-12)


def test_the_picture_of_a_crystal_has_the_edges_of_its_cell_and_its_formula(tmp_path):
    pytest.importorskip("gemmi")
    text = CRYSTAL.replace("length_c 4", "length_c 7").replace("P m -3 m", "P m m m")
    text = text.replace("loop_", "_chemical_formula_sum 'Cs Cl'\nloop_")
    path = written(tmp_path, f"{text}Cs1 Cs 0 0 0.2 1\nCl1 Cl 0.5 0.5 0.5 1\n", "salt.cif")
    look = vizlight.look(path)
    meshes = (layer.mesh.run() for layer in look.drawing.layers)
    (cell,) = (mesh for mesh in meshes if getattr(mesh, "n_lines", 0) == 12)
    np.testing.assert_allclose(cell.bounds, (0, 4, 0, 4, 0, 7), atol=1e-4)
    assert look.key[0]["title"] == "CsCl"
    # Without a formula it is the name of the file.
    path.write_text(path.read_text().replace("_chemical_formula_sum 'Cs Cl'\n", ""))
    assert vizlight.look(path).key[0]["title"] == "salt"


def test_a_macromolecule_of_cif_is_that_of_pdb(tmp_path):
    gemmi = pytest.importorskip("gemmi")
    path = written(tmp_path, "".join([*helix(40, "A"), *helix(40, "B")]), "two.pdb")
    of_pdb = vizlight.read(path)
    document = gemmi.read_pdb(str(path)).make_mmcif_document()
    document.write_file(str(tmp_path / "two.cif"))
    of_cif = vizlight.read(tmp_path / "two.cif")
    np.testing.assert_allclose(of_cif.points, of_pdb.points, atol=1e-3)
    assert {*of_cif.point_data.keys()} == {*of_pdb.point_data.keys()}
    for name in ("atom_type", "residue", "chain", "backbone_mask"):
        np.testing.assert_array_equal(of_cif[name], of_pdb[name])


@pytest.mark.parametrize(
    ("text", "said"),
    [("data_a\n_cell_length_a 4\n", "no atoms"), ("loop_ 'x", r"line 1.*block header")],
)
def test_a_cif_without_atoms_is_refused(tmp_path, text, said):
    pytest.importorskip("gemmi")
    refused(written(tmp_path, text, "a.cif"), said)


def test_cations_of_a_crystal_are_not_joined_and_metals_are(tmp_path):
    def atoms(first, second, side):
        places = np.argwhere(np.ones((2, 2, 2)))
        names = [second if sum(place) % 2 else first for place in places]
        rows = [f"{name} {x} {y} {z}" for name, (x, y, z) in zip(names, side * places, strict=True)]
        return written(tmp_path, "8\n\n" + "\n".join(rows) + "\n", "a.xyz")

    oxide = vizlight.read(atoms("Mg", "O", 2.106))
    assert oxide.n_lines == 12
    ends = oxide.lines.reshape(-1, 3)[:, 1:]
    assert (oxide["atom_type"][ends].sum(axis=1) == 20).all()
    # All along edges and faces of the cube.
    copper = vizlight.read(atoms("Cu", "Cu", 2.0))
    assert copper.n_lines >= 12
    assert vizlight.look(copper).shown == "molecule"


def test_bonds_are_those_of_atoms_not_of_beads_that_meet(tmp_path):
    """A peptide in water has bonds of the usual lengths, beads at any distance."""
    alone = [f"O {5 * i} 9 9" for i in range(8)]
    peptide = ["C 0 0 0", "N 1.33 0 0", "C 2 1.25 0", "O -0.6 1.05 0"]
    text = "\n".join(["12", "", *peptide, *alone, ""])
    assert vizlight.read(written(tmp_path, text, "wet.xyz")).n_lines == 3
    beads = ["C 0 0 0", "C 1.9 0 0", "C 0 3 0", "C 0 3.9 0"]
    text = "\n".join(["12", "", *beads, *alone, ""])
    mesh = vizlight.read(written(tmp_path, text, "beads.xyz"))
    assert (mesh.n_lines, mesh.n_verts) == (0, 12)

"""Every class of warning, and `warn`, which points at the user's line from however deep inside."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_OWN = __name__.partition(".")[0]
# of this thread (or task), the kinds that `untold` holds back
_UNTOLD: ContextVar[tuple[type[Warning], ...]] = ContextVar("_UNTOLD", default=())


class Notice(UserWarning):
    """A notice: a number rests on something that the program doubts; the base of all warnings here.

    Every class below says in its docstring what it doubts, and in the paragraphs "When:" and "Remedy:" when
    it is raised and what helps. The documentation's table is made from them.
    """


class CoarseStep(Notice):
    """One of the notices: the time step does not follow something that drives the march, or its start.

    When: a wave of a bearing, the passage of its balls, a pit, an unbalance, a harmonic or a sampled load has
    fewer than twenty steps a period, at the highest speed of the profile; or modes that have fewer carry a
    tenth or more of the swing that a displacement by `initial=` lets go, in a recorded motion (after
    `settle`).

    Remedy: march with the dt that the warning names, or leave out what is that fast; `check_step=True` says
    how far off the record is.
    """


class GrowingStep(Notice):
    """One of the notices: exact steps of this size make a motion grow that balls hold.

    When: at `method="exact"`, about an equilibrium, a mode of which balls hold a share gains more by a step
    than its damping takes, so that it is 1 % larger at the end.

    Remedy: march with the dt that the warning names, or with method="newmark"; or give the contacts the
    damping that they have.
    """


class FitWarning(Notice):
    """One of the notices: two neighbours at one interface hardly fit, by what is known of radii and widths.

    When: radii 1 to 5 % apart (above, they are refused); a bearing or a bonded layer that has less than nine
    tenths of its width on its seat; two interfaces joined that both face outwards, or both inwards.

    Remedy: correct the dimension, or pass `fits=False` to `connect` or `bearing` where they are meant to
    differ.
    """


class OpenSideWarning(Notice):
    """One of the notices: motion pressed an angular contact bearing where it has no shoulder, or not onto it.

    The motion computed from then on is that of a bearing with two shoulders.

    When: a motion given to a `BallBearing`, a march, a steady motion or a map in which a ball that carries
    (1 % of the largest ball load) stood beyond the bottom of its groove, on the open side, or in which all
    that carry stood on the bottom, no axial load pressing them onto the shoulder. The bearing, the first time
    and the number of steps are named, or the speed and the share of the time.

    Remedy: more preload, or the bearing hung the other way round, `bearing.mirrored()`; with shoulders on
    both sides it has `open_side=None`.
    """


class UnusualMagnitude(Notice):
    """One of the notices: an input is larger or smaller than machines have it, probably in another unit.

    When: a number lies outside the usual range of its row in `bearingdyn.plausible_ranges.MAGNITUDES`, where
    it is given or where what it is compared with becomes known.

    Remedy: give it in SI units; the text names the unit that was probably meant and the number in SI. A
    machine that is rightly so unusual needs nothing: the number is used as it is.
    """


class BearingWarning(Notice):
    """One of the notices: a bearing is asked for more than its parts bear, or than its model covers.

    When: a contact pressure exceeds 4.2 GPa (ISO 76), the static rating, in an equilibrium, in any step of a
    march, in a steady motion or a map, or in a response to unbalance or of a given amplitude, the balls
    pressed as the rings then move; a load exceeds the static rating that friction or a life is asked with;
    the rings lean against each other by more than .01 rad in an equilibrium, or under a load or motion given;
    in a sheet also where a shoulder cuts a contact ellipse, or a bearing carries nothing.

    Remedy: check the load's unit; a larger bearing, less load, or a higher shoulder.
    """


class ClampedBalls(Notice):
    """One of the notices: fits and warmth have eaten a bearing's clearance, and its rings clamp the balls.

    When: `Mounting.mounted` leaves a deep-groove bearing less than no clearance. The text says how hard each
    ball is pressed before any load.

    Remedy: looser fits, or a larger clearance class; none where the bearing is meant to run clamped.
    """


class PassedOver(Notice):
    """One of the notices: a designation says something that the model of a bearing does not know.

    When: `catalogue.bearing` reads a maker's name, seals, shields, a cage, a tolerance class, or a clearance
    class beside a given clearance. The text says how the rest was read.

    Remedy: none where that is what was meant; write the bare number, as "6205" or "6205 C3", to have no
    warning.
    """


class UnloadedBearing(Notice):
    """One of the notices: an analysis stands on a bearing that carries nothing, and so has no stiffness.

    When: modes, a response or a Campbell diagram start from an equilibrium in which no ball of a bearing is
    pressed.

    Remedy: load the bearing (weight by `app.gravity`, a belt, an axial preload by `offset`), or give it no
    clearance.
    """


class NothingPushes(Notice):
    """One of the notices: nothing pushes, so a march stays as it begins, and a steady motion is none.

    When: a march from an equilibrium in which no ball is pressed, of an application without any load, from
    no displacement by `initial=` and no earlier state; `steady_state` of such an application, where no ball
    is pressed along the motion found. A map refuses it.

    Remedy: add what pushes (`app.gravity`, `app.load`, `app.unbalance`), or start displaced with
    `initial=`; zero speed and zero load need no march.
    """


class BeyondData(Notice):
    """One of the notices: a static answer rests on a modulus at longer times than the rubber's data speak of.

    When: `equilibrium`, a response at 0 Hz or a stiffness at rest takes the modulus of a layer relaxed, or
    `after` a time more than twice the longest that its fit reaches, and the data show no plateau there.

    Remedy: ask for the state `after` a time that the data reach; fit from a lower frequency; pin the low end
    (`fit_maxwell(pin=...)`); measure longer, or warmer.
    """


class StrainedLayer(Notice):
    """One of the notices: rubber's linear stiffness is wrong at the displacement an equilibrium gives it.

    When: `equilibrium` displaces the surfaces of a Layer against each other, across the axis, by more than
    4 % of its thickness: there its stiffness has risen by 1 %. The text says by how much the state itself,
    and a small motion about it, is wrong. Along the axis the linear stiffness is good to 1 % up to 20 % of
    the thickness, and nothing warns. A Solid with rubber strained by more than .1 % rms is solved again at
    finite strain, unless it has more than 12 000 coordinates, and the text tells the two answers apart where
    they differ by 1 %: a pad pressed by .4 % of its height.

    Remedy: less load or a thicker layer; give the application what `assembled` returns for that motion; or
    take the figures of the text as the error of the answer.
    """


class MeshDependent(Notice):
    """One of the notices: the answer of a squeezed part changes by more than 1 % between two meshes.

    When: `assembled` finds another force or static stiffness on a coarser mesh; at the sharp edge of a bond
    the strain is singular, and near to folding the mesh decides.

    Remedy: a greater `refinement`; a recess at the edges of the bonds; `compare=False` where it is known.
    """


class BeyondSweep(Notice):
    """One of the notices: a rubber vibrates with more strain than its law of softening was found from.

    When: a response or a march with a law of softening (`payne`) reaches a strain above the highest of the
    strain sweep.

    Remedy: measure the strain sweep further; or take the answer as an extrapolation of the law.
    """


class OutsideIsotherms(Notice):
    """One of the notices: a shift law is used at a temperature at which nothing was measured.

    When: a material is moved to (`at`, `Application.temperature`), or a master curve referred to, a
    temperature outside the isotherms its law was found from.

    Remedy: measure there, or take the answer as an extrapolation of the law.
    """


class PoorLaw(Notice):
    """One of the notices: a shift law renders the shifts of the isotherms far worse than they are known.

    When: `master_curve` fits a law that misses the shifts by 0.3 decade rms, or by ten times their own
    standard errors, or that doubles the misfit of the moduli.

    Remedy: another law ("joined" through a glass transition, "free"), or fewer isotherms.
    """


class UnevenShifts(Notice):
    """One of the notices: shifts of isotherms zigzag, or rise with temperature, as no polymer's do.

    When: a step of `master_curve`'s shifts, per kelvin, is below half the smaller, or above twice the
    larger, of its neighbours by 0.15 decade or more, or has the other sign; or the isotherms, shifted, leave
    a gap of more than 0.3 decade.

    Remedy: look at the isotherms named; leave one out, give its shift by hand, or measure again, in between
    or over a wider range of frequency.
    """


class OddPoints(Notice):
    """One of the notices: single moduli of a measurement stand off the curve of all others.

    When: after `master_curve` has superposed them, G′ or G″ of a point deviates from one causal spectrum by
    more than 10 %, and ten times the scatter of the others.

    Remedy: look at the points named; measure them again, or leave them out by `dma.take` or `dma.select`.
    """


class MixedRuns(Notice):
    """One of the notices: a curve is of several runs, whose levels may differ by more than the fit's errors.

    When: `master_curve` gets points of several runs, as a column of the table names them, that nobody chose.

    Remedy: `dma.select(run="a")` for one run; `dma.select(run=["a", "b"])` says that they are meant together.
    """


class UnequalRuns(Notice):
    """One of the notices: runs (specimens) of one measurement stand at different levels.

    When: `master_curve` finds that the moduli of a run have to be multiplied by a factor more than 2 % and
    three standard errors from 1, so that all runs follow one law; or cannot tell the level of a run.

    Remedy: check the specimens' thickness and clamping; choose one run by `dma.select(run=...)`, or give
    `levels={run: factor}`; `levels=None` leaves moduli as measured.
    """


class CutFile(Notice):
    """One of the notices: a file ends inside a character: cut off in copying, its last line is left out.

    When: `read_dma` reads a UTF-16 text of an odd number of bytes.

    Remedy: export or copy the file again.
    """


class OutsideBand(Notice):
    """One of the notices: a material model is used at a frequency it was not fitted at.

    When: a Maxwell model that knows its band is asked for its modulus outside it, in a response, in damped
    modes or by `complex_modulus`; or `fit_maxwell` is given a band that reaches beyond the master curve.

    Remedy: fit a band that covers the frequencies asked for, with data that reach there; or take the answer
    as an extrapolation.
    """


class AssumedMeaning(Notice):
    """One of the notices: a file does not say what a number means, and the usual is taken.

    When: `read_dma` finds no unit for a frequency or a temperature, an angular frequency in a unit of
    frequency, moduli of which only the words around them tell shear from tension, or a temperature only in
    the file's name; or when the first of several sheets that hold a table is read; when `read_strain_sweep`
    finds no unit for a strain.

    Remedy: say it: `units={...}`, `mode=...`, `temperature=...`, `step=...`; the text names the argument.
    """


class LeftOut(Notice):
    """One of the notices: something of a file or measurement is not used.

    When: `read_dma` leaves out rows that are not valid or stand behind the table; `master_curve` leaves out
    points that no passive material could give, such as a resonance of the fixture; `read_mesh` leaves out
    beams, masses, springs and other elements without volume.

    Remedy: look at the rows or points named; `clean=False` keeps what is positive, `dma.select` leaves out
    more. Add masses and springs of a mesh to the application (`RigidBody`, `Application.spring`).
    """


class UnlikelyModulus(Notice):
    """One of the notices: a measured modulus is far from what gels and polymers have; a wrong unit.

    When: the median of the storage moduli that `read_dma` read lies outside 100 Pa to 20 GPa, or no storage
    modulus is as large as a rubber's; or a relaxation modulus rises with time by more than 10 %.

    Remedy: give the unit of the columns: `units={"storage": "MPa", "loss": "MPa"}`.
    """


class ThinIsotherm(Notice):
    """One of the notices: a shift rests on a single point.

    When: `master_curve` meets an isotherm with one frequency only.

    Remedy: leave that temperature out by `dma.select`, or measure a sweep there.
    """


class CoarseModel(Notice):
    """One of the notices: no number of branches tried renders the measurement within the tolerance.

    When: `fit_maxwell(n="auto")` has tried all it may.

    Remedy: a narrower band, a larger `tolerance`, or better data: a causal spectrum as dense as it may be
    leaves the floor that the text names.
    """


class FewerBranches(Notice):
    """One of the notices: a fit has fewer branches than were asked for, for the data hold no more.

    When: `fit_maxwell` finds that further branches have no strength, or help by less than 1e-4 of the
    misfit. The fit is as good as one with all of them.

    Remedy: ask for the number that the text names, or for n="auto".
    """


class TensionAsShear(Notice):
    """One of the notices: moduli measured in tension are turned into shear by the bulk modulus alone.

    When: `fit_maxwell` is given a master curve in tension.

    Remedy: `master.to_shear(K=...)` or `to_shear(nu=...)` beforehand says how it is meant.
    """


class VolumeCounts(Notice):
    """One of the notices: a thin layer's radial stiffness hangs on its bulk modulus, which DMA leaves open.

    When: a layer is reduced whose radial stiffness changes by 0.1 % or more where K changes by 1 %; from 1 to
    3 GPa, between which K of rubbers is told, that is 12 % or more.

    Remedy: measure K, or tell what its doubt does, by `bd.study.doubt_effects` and
    `bd.doubts(rubber, K=(1e9, 3e9))`.
    """


class FoldedMesh(Notice):
    """One of the notices: elements of a mesh overlap, one folded into others, its volume counted twice.

    When: two elements of a mesh lie on the same side of a face that they share. gmsh writes such tetrahedra
    beside pyramids now and then.

    Remedy: mesh again with other sizes, or without pyramids; the text names the element and the place.
    """


class CoarsePanels(Notice):
    """One of the notices: triangles of a radiating surface are longer than a sixth of the wavelength.

    When: `sound.solve` or `sound.radiated_power` is given a surface with a longer side of a triangle,
    or `sound_power` an element size that is too large for its highest frequency.

    Remedy: a finer mesh, or no `element_size`; below the frequency that the text names the mesh will do.
    """


class BeyondModes(Notice):
    """One of the notices: sound is asked for above the frequency up to which a part was reduced.

    When: `sound_power` gets a frequency above the `f_max` of a part that radiates.

    Remedy: a higher `f_max` of the part, or lower frequencies; the part's own modes above f_max are lacking.
    """


class RepairedResistance(Notice):
    """One of the notices: a radiation resistance had motions of negative power, which were set to zero.

    When: `sound_power` finds an eigenvalue of the resistance below −1e-4 of the largest.

    Remedy: a smaller `element_size`: the panels are too coarse for the part.
    """


class UnsureInterpolation(Notice):
    """One of the notices: sound power between the frequencies solved at is less sure than 0.05 dB.

    When: `sound_power` has solved as many frequencies in an octave as it may, and the last of them still
    disagreed with the rest.

    Remedy: a narrower band, or bodies and floors closer together: their echoes swing over frequency.
    """


class ClippedSound(Notice):
    """One of the notices: a sound file of 16 bits cannot hold the largest pressures.

    When: `write_wav(bits=16, full_scale=...)` gets a pressure above the full scale.

    Remedy: the full scale that the text names, or `bits=32`.
    """


class OilAtOtherSpeed(Notice):
    """One of the notices: a lubricated bearing is asked at another speed than that of its films.

    When: a march, a response, modes or a steady motion at a speed, not zero, that is more than 25 % above or
    below that of a bearing's `lubrication`; films and the damping of contacts are constants of that speed.

    Remedy: `lubrication=OilSupply(..., speed=)` of the speed asked; for a range of speeds, one of each.
    """


class FewOrders(Notice):
    """One of the notices: a flexible ring moves by fewer orders than its bearing has balls.

    When: a bearing is hung in a ring made without it (`FlexibleRing(..., arm=)`), whose order is below the
    number Z of balls: equal loads on all of them bend it by cos Zψ, which it then lacks. At order 6 under
    seven balls what a ring adds to Hertz is 43 % low.

    Remedy: `FlexibleRing(..., bearing=)`, which takes Z + 1 orders and folds in those beyond; or that order.
    """


class StandingUnbalance(Notice):
    """One of the notices: an unbalance is on a part that stands.

    When: an application is joined in which some part turns (one with gyroscopic forces, what is connected to
    it, a ring that turns), and an unbalance is on another, that no connection joins to these.

    Remedy: the unbalance on the part that turns; or, where its part does turn, `rotating=True`.
    """


class ChangedFunction(Notice):
    """One of the notices: processes of a study computed another function than the one at hand.

    When: `study.sweep` sends a function to other processes, which import its module afresh, and a global
    value, default or attribute that it uses was changed after the import here.

    Remedy: pass what changes as a parameter of the cases; or give an executor of threads.
    """


class UnprovenOptimum(Notice):
    """One of the notices: an optimiser's best design misses the conditions of an optimum.

    When: `study.optimise` or `study.front` ends where the scaled objective's gradient, after the limits that
    are reached, is more than 5 % of the steepest on the way: the function is noisy, jumps, or its slopes are
    wrong.

    Remedy: more starts; smoother values (a tighter tolerance inside the function, the same mesh for all
    designs), slopes of the function's own, or a study by `study.sobol` where it is not smooth.
    """


class CutHarmonics(Notice):
    """One of the notices: a steady motion wants more harmonics than it was given.

    When: the harmonics next above the last of a `steady_state`, or of a point of a `speed_map` or a
    `parameter_map`, would add more than 2 % of a channel's largest line (of a map, the worst point is named);
    or, of several base frequencies, a line above the last that would be 2 % of the bearings' largest.

    Remedy: more `harmonics`; a pit or a ball that loses contact needs many.
    """


class UnfinishedLine(Notice):
    """One of the notices: the last number of a text file may have been cut.

    When: the file's last line has no line end, which programs write and a copy that broke off lacks.

    Remedy: compare the file's length with the original; if it is whole, add a line end.
    """


@contextmanager
def untold(*kinds: type[Notice]) -> Iterator[None]:
    """Hold notices of these kinds back, in this thread alone: what they would say is told otherwise.

    The filters of `warnings` belong to all threads at once: one that changes them silences others.
    """
    before = _UNTOLD.set((*_UNTOLD.get(), *kinds))
    try:
        yield
    finally:
        _UNTOLD.reset(before)


def warn(text: str, category: type[Notice]) -> None:
    """Issue a notice at the nearest caller that is not of this package.

    The caller is known by its module's name, not its file: the `__init__` of a dataclass has no file.
    """
    if issubclass(category, _UNTOLD.get()):
        return
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] == _OWN:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)

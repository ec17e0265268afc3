// SPDX-License-Identifier: GPL-3.0-or-later

#include "Guards.H"

#include <cmath>

namespace
{

//- Text of numbers and words, as OpenFOAM writes them
template<class... Parts>
string text(const Parts&... parts)
{
    OStringStream stream;
    const int each[] = {(stream << parts, 0)...};
    (void)each;
    return stream.str();
}

}

bedFoam::Guards::Guards(
    const fvMesh& mesh, const dictionary& parameters, const dictionary& gas, const Liggghts& dem
)
    : mesh_(mesh),
      largestOverlap_(parameters.get<scalar>("largest_overlap")),
      stopAtClip_(gas.get<word>("voidageClip") == "stop"),
      number_(returnReduce(scalar(dem.count()), sumOp<scalar>()))
{
    const std::vector<Plane> planes{
        {"left", 0, 0, 1},
        {"right", 0, parameters.get<scalar>("width"), -1},
        {"bottom", 2, 0, 1},
        {"front", 1, parameters.get<scalar>("slab_low"), 1},
        {"back", 1, parameters.get<scalar>("slab_high"), -1}
    };
    // A bed of one layer has no walls in front and behind
    for (const Plane& plane : planes)
        if (dem.hasFix(plane.name)) walls_.push_back(plane);
}

void bedFoam::Guards::stop(const Finding& found, const char* remedy) const
{
    Finding worst(found);
    reduce(worst, [](const Finding& a, const Finding& b) { return b.first() > a.first() ? b : a; });
    if (!Pstream::master())
    {
        // The first rank ends all of them while the others wait here
        returnReduce(label(0), sumOp<label>());
    }
    FatalErrorInFunction << worst.second().c_str() << ", at " << mesh_.time().value()
                         << " s. The last finished segment is intact: " << remedy << exit(FatalError);
    std::abort();
}

bedFoam::Guards::Finding bedFoam::Guards::worstCell(const scalarField& magnitude, const char* what) const
{
    Finding worst(-1, "");
    forAll(magnitude, cell)
    {
        const scalar badness = std::isfinite(magnitude[cell]) ? magnitude[cell] : VGREAT;
        if (badness <= worst.first()) continue;
        worst =
            Finding(badness, text(what, ' ', magnitude[cell], " in the gas cell at ", mesh_.C()[cell], " m"));
    }
    return worst;
}

void bedFoam::Guards::checkNumber(const Liggghts& dem)
{
    const scalar number = returnReduce(scalar(dem.count()), sumOp<scalar>());
    if (number < number_)
    {
        List<labelList> ids(Pstream::nProcs());
        ids[Pstream::myProcNo()].resize(dem.count());
        for (int i = 0; i < dem.count(); ++i) ids[Pstream::myProcNo()][i] = dem.id(i);
        Pstream::gatherList(ids);
        Pstream::scatterList(ids);
        labelHashSet left;
        for (const labelList& ofRank : ids) left.insert(ofRank);

        Finding lost(-1, "");
        for (const auto& particle : seen_)
        {
            if (left.found(particle.first)) continue;
            lost = Finding(
                1,
                text(
                    "particle ", particle.first, " has left the bed (", number_ - number,
                    " lost), last seen at ", particle.second, " m"
                )
            );
        }
        stop(
            lost,
            "reduce time.dem_step_s, or time.gas_step_s where many are lost at once,"
            " or raise bed.height_m where it left through the top"
        );
    }
    seen_.resize(dem.count());
    for (int i = 0; i < dem.count(); ++i)
    {
        const double* x = dem.position()[i];
        seen_[i] = {label(dem.id(i)), vector(x[0], x[1], x[2])};
    }
}

void bedFoam::Guards::checkOverlap(const Liggghts& dem)
{
    const Overlap own = dem.deepestOverlap(walls_);
    const scalar deepest = returnReduce(scalar(own.depth), maxOp<scalar>());
    deepest_ = max(deepest_, deepest);
    if (deepest <= largestOverlap_) return;
    const vector place(own.place[0], own.place[1], own.place[2]);
    stop(
        Finding(
            own.depth,
            text(
                "particle ", label(own.particle), " at ", place, " m and ", own.other.c_str(), " overlap by ",
                own.depth, " diameters, above contact.largest_overlap_1 (", largestOverlap_, ")"
            )
        ),
        "reduce time.dem_step_s, or raise contact.young_modulus_Pa with a step that fits it"
    );
}

void bedFoam::Guards::checkParticles(const Liggghts& dem)
{
    // A burst of overlaps throws particles out: it is the cause that is reported
    checkOverlap(dem);
    checkNumber(dem);
}

void bedFoam::Guards::checkVoidage(const VoidageClips& clips) const
{
    if (!stopAtClip_ || clips.number == 0) return;
    const vector place = clips.cell < 0 ? vector::zero : mesh_.C()[clips.cell];
    stop(
        Finding(
            -clips.least,
            text(
                "voidage ", clips.least, " in the gas cell at ", place, " m, below what a bed can have (",
                clips.number, " cells)"
            )
        ),
        "check bed.thickness_m, or take a larger gas.cell_size_m or gas.smoothing_diameters_1;"
        " gas.voidage_clip: count goes on with a raised voidage"
    );
}

void bedFoam::Guards::checkPressure(
    const SolverPerformance<scalar>& solve, const fvScalarMatrix& equation
) const
{
    if (solve.converged()) return;
    Finding worst(worstCell(mag(equation.residual()), "largest residual"));
    worst.second() = text(
        "the pressure is not solved after ", solve.nIterations(), " iterations (residual ",
        solve.initialResidual(), " before, ", solve.finalResidual(), " after), ", worst.second().c_str()
    );
    stop(worst, "reduce time.gas_step_s");
}

void bedFoam::Guards::checkFinite(scalar pressureDrop, scalar kineticEnergy, const volVectorField& U) const
{
    if (std::isfinite(pressureDrop + kineticEnergy)) return;
    Finding worst(worstCell(mag(U.primitiveField()), "fastest gas [m/s]"));
    worst.second() = text(
        "the run has diverged (pressure drop ", pressureDrop, " Pa, kinetic energy ", kineticEnergy, " J), ",
        worst.second().c_str()
    );
    stop(worst, "reduce time.gas_step_s or time.dem_step_s");
}

scalar bedFoam::Guards::takeDeepestOverlap()
{
    const scalar deepest = deepest_;
    deepest_ = 0;
    return deepest;
}

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Gas volume balance, closed: d(e)/dt + div(e U) = 0 with e the particles' own voidage
//
// The face's momentum is the mean of its two cells' momentum over e, A/e U = H/e - grad(p): where drag
// jumps, as at the top of the bed, their resistances are in series. There the pressure gradient of a cell
// jumps too, and no difference over two cells has it: the cell's velocity is put together from the fluxes,
// and only what they do not see (shorter than two cells) from its own momentum.

#include "constrainHbyA.H"
#include "constrainPressure.H"
#include "fvCFD.H"

#include "BandPreconditioner.H"
#include "gasEquations.H"

namespace
{

// Cells in a row up to which the band is factorized: that work grows with their square, multigrid's does not
constexpr label widestBand = 100;

//- The pressure's entry in fvSolution: multigrid, or its band where that is exact
const dictionary& pressureSolver(const volScalarField& p, bool last)
{
    const bool band = !Pstream::parRun() && bedFoam::bandWidth(p.mesh().lduAddr()) <= widestBand;
    return p.mesh().solver(word(band ? "pBand" : "p") + (last ? "Final" : ""));
}

}

bedFoam::PressureCorrector::PressureCorrector(
    const fvVectorMatrix& UEqn, const SolidsFields& solids, const surfaceScalarField& voidagef,
    const Reconstruction& reconstruct, const GasFields& gas
)
    : UEqn_(UEqn),
      solids_(solids),
      voidagef_(voidagef),
      reconstruct_(reconstruct),
      A_("A", UEqn.A()),
      rAU_("rAU", 1 / A_),
      rAUfree_("rAUfree", 1 / (A_ - solids.dragRate)),
      rAUf_("rAUf", 1 / fvc::interpolate(A_ / solids.voidage)),
      rateOfFlux_("rateOfFlux", rAUf_ * fvc::ddtCorr(gas.U, gas.phi))
{}

surfaceScalarField bedFoam::PressureCorrector::fluxWithoutPressure(
    const volVectorField& H, const volVectorField& HbyA
) const
{
    surfaceScalarField phiHbyA("phiHbyA", rAUf_ * fvc::flux(H / solids_.voidage));
    forAll(phiHbyA.boundaryField(), patch)
    {
        const fvPatch& faces = HbyA.mesh().boundary()[patch];
        if (faces.coupled()) continue;
        phiHbyA.boundaryFieldRef()[patch] = faces.Sf() & HbyA.boundaryField()[patch];
    }
    return phiHbyA;
}

void bedFoam::PressureCorrector::correct(const Guards& guards, pisoControl& piso, GasFields& gas) const
{
    const volScalarField& voidage = solids_.voidage;
    volScalarField& p = gas.p;
    volVectorField& U = gas.U;

    const volVectorField H(UEqn_.H());
    const volVectorField HbyA = constrainHbyA(rAU_ * H, U, p);
    const volVectorField HbyAfree = constrainHbyA(rAUfree_ * (H - solids_.dragSource), U, p);

    surfaceScalarField phiHbyA = fluxWithoutPressure(H, HbyA);
    phiHbyA += rateOfFlux_;
    constrainPressure(p, U, phiHbyA, rAUf_);

    while (piso.correctNonOrthogonal())
    {
        fvScalarMatrix pEqn(
            fvm::laplacian(voidagef_ * rAUf_, p) == fvc::ddt(voidage) + fvc::div(voidagef_ * phiHbyA)
        );
        guards.checkPressure(pEqn.solve(pressureSolver(p, piso.finalInnerIter())), pEqn);
        if (piso.finalNonOrthogonalIter()) gas.phi = phiHbyA - pEqn.flux() / voidagef_;
    }

    U = reconstruct_(gas.phi) + (rAU_ / rAUfree_) * (HbyAfree - reconstruct_(fvc::flux(HbyAfree)));
    U.correctBoundaryConditions();
}

void bedFoam::PressureCorrector::setGradient(GasFields& gas) const
{
    gas.gradP = (UEqn_.H() - A_ * gas.U) / solids_.voidage;
}

scalar bedFoam::volumeImbalance(
    const volScalarField& voidage, const surfaceScalarField& voidagef, const surfaceScalarField& phi
)
{
    const scalarField imbalance =
        (fvc::ddt(voidage) + fvc::div(voidagef * phi))().primitiveField() * voidage.time().deltaTValue();
    return gMax(mag(imbalance)());
}

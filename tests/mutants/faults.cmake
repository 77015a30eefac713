# SPDX-License-Identifier: BSD-3-Clause
# The faults, room by room. A fault is small, compiles, and is one that somebody could make; see mutants.cmake.

# Gauss-Lobatto weights of a rule with one point more; right for no degree.
livens_mutant(NAME lobatto_weight
              FILE time/quadrature.cpp
              OLD [[2 / (n * (n + 1) * p * p)]]
              NEW [[2 / ((n + 1) * (n + 2) * p * p)]]
              TESTS_OF unit_time
              MUST_FAIL GaussLobatto.IsExactToItsDegreeAndNoFurther
                        GaussLobatto.PointsAndWeightsAreRightToTheLastBits)

# Steiner's term with the wrong sign: right while the reference point is the centre of mass.
livens_mutant(NAME second_moment_sign
              FILE multibody/mass_properties.cpp
              OLD [[- J + properties.mass * outer(c, c)]]
              NEW [[- J - properties.mass * outer(c, c)]]
              TESTS_OF unit_multibody
              MUST_FAIL MassProperties.MassMatrixHoldsTheSecondMomentsAboutTheReferencePoint)

# The moments of a skew body taken for those along perpendicular axes: right for all other bodies.
livens_mutant(NAME skew_moments
              FILE multibody/body.cpp
              OLD [[mass_properties(A * mass * transpose(A))]]
              NEW [[mass_properties(mass)]]
              TESTS_OF unit_multibody
              MUST_FAIL SkewBodies.AreTheirOrthonormalSelvesInOtherCoordinates)

# The factor 1/2 of (P21) forgotten.
livens_mutant(NAME torque_half
              FILE multibody/loads/torque.cpp
              OLD [[0.5 * cross(mu, D.column(i))]]
              NEW [[cross(mu, D.column(i))]]
              TESTS_OF unit_multibody
              MUST_FAIL Torque.HasItsMomentForEveryTriadThatIsNotFlat
                        Torque.DoesTheWorkOfItsSpinOnRigidStates)

# The mixed term of d2 Phi/dt2 counted once instead of twice: wrong reactions, right motion.
livens_mutant(NAME curvature_mixed_term
              FILE multibody/constraint.cpp
              OLD [[2 * product(V_i, f.c_ij, V_j)]]
              NEW [[product(V_i, f.c_ij, V_j)]]
              TESTS_OF unit_multibody
              MUST_FAIL ConstraintRow.GradientAndCurvatureAreThoseOfAQuadraticForm)

# Drives forgotten in the velocity at element ends: all order is gone.
livens_mutant(NAME velocity_without_drives
              FILE dynamics/instant/instant.cpp
              OLD [[for (double& rate : row_rates_) rate = -rate;]]
              NEW [[for (double& rate : row_rates_) rate = 0;]]
              TESTS_OF convergence
              MUST_FAIL Drives.APendulumOnADrivenPivotHasOrder2p
                        Drives.ARodOfDrivenLengthHasOrder2p)

# The last weight off by one part in a thousand: the order is gone.
livens_mutant(NAME one_weight
              FILE spacetime/elements/rule.cpp
              OLD [[rule.weights = gauss_lobatto(n).weights;]]
              NEW [[rule.weights = gauss_lobatto(n).weights; rule.weights[rule.degree] *= 1.001;]]
              TESTS_OF convergence
              MUST_FAIL Lobatto.ConvergesWithOrder2POnTheFreeBox
                        Lobatto.ConvergesWithOrder2POnTwoBricksInSpace
                        Lobatto.ConvergesWithOrder2POnRevolutes)

# One wrong sign in d_i x r_i.
livens_mutant(NAME sign_of_a_moment
              FILE dynamics/rows/twist.h
              RECOMPILE dynamics/rows/body_tables.cpp spacetime/nodal/tangent.cpp
              OLD [[m[1] += X[a + 2] * r[a] - X[a] * r[a + 2];]]
              NEW [[m[1] += X[a + 2] * r[a] + X[a] * r[a + 2];]]
              TESTS_OF convergence
              MUST_FAIL Radau.ConvergesWithOrder2PLess1OnTheFreeBox)

# The turning of the rows left out of the tangent: the answer stays, convergence is linear.
livens_mutant(NAME missing_geometric_term
              FILE spacetime/nodal/tangent.cpp
              OLD [[twist::add_geometric(nodes.X(A) + 12 * b, at.total.data() + 12 * b, at.blocks.data() + 36 * b, 6);]]
              NEW [[(void)b;]]
              TESTS_OF convergence
              MUST_FAIL Newton.NeedsThreeIterationsAnElementOnTheAverage
                        Newton.FactorisesOnceAnElementWhereErrorsAreSmall)
livens_mutant(NAME missing_geometric_term_by_differences
              FILE spacetime/nodal/tangent.cpp
              OLD [[twist::add_geometric(nodes.X(A) + 12 * b, at.total.data() + 12 * b, at.blocks.data() + 36 * b, 6);]]
              NEW [[(void)b;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Lobatto/TangentOf.MatchesDifferencesWithEveryKindOfTerm/*)

# Loads taken where the element starts, their moments where it has come to: a spring that turns what it holds.
livens_mutant(NAME loads_at_the_start
              FILE spacetime/nodal/laws/element_loads.cpp
              OLD [[X[l] += M_[B * W + l] * dX;]]
              NEW [[X[l] += 0 * M_[B * W + l] * dX;]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.AgreesWithNewtonOnRandomMechanisms)
livens_mutant(NAME loads_at_the_start_in_lanes
              FILE dynamics/lanes/lane_loads.h
              RECOMPILE spacetime/elements/lanes_sse2.cpp
              OLD [[at_start + times<W>(moved + i * W, M)]]
              NEW [[all<W>(at_start)]]
              TESTS_OF conservation
              MUST_FAIL Lobatto.BalancesAngularMomentumOverTenSeconds Lobatto.KeepsMomentaOfAFloatingChain)

# Loads at as many Gauss-Lobatto points: springs are no Gauss collocation then, and stable no longer.
livens_mutant(NAME loads_at_lobatto_points
              FILE spacetime/elements/rule.cpp
              OLD [[rule.loads = gauss(rule.degree);]]
              NEW [[rule.loads = rule.degree > 1 ? gauss_lobatto(rule.degree) : gauss(1);]]
              TESTS_OF properties
              MUST_FAIL IntegratorKit.LONG_EveryMethodIsStableAsStated
                        IntegratorKit.LONG_EveryMethodIsStableInTurnsAsStated
                        IntegratorKit.TheLibrarysElementIsThatByHand)

# What a load does at a Gauss point given to one node, instead of shared out: impulses are right, moments not.
livens_mutant(NAME loads_given_to_one_node
              FILE spacetime/nodal/laws/element_loads.cpp
              OLD [[forces[i] += rule_.M[c * n_nodes + A] * at.F]]
              NEW [[forces[i] += (A == c ? 1 : 0) * at.F]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.AgreesWithNewtonOnRandomMechanisms)

# The instant of a node for what is taken at a Gauss point: right for constant loads only.
livens_mutant(NAME loads_at_the_instants_of_nodes
              FILE spacetime/elements/window_layout.h
              RECOMPILE spacetime/nodal/laws/element_loads.cpp spacetime/nodal/kernel/kernel_wrenches.cpp
              OLD [[rule.loads.points[c] * h(e), Side::middle}]]
              NEW [[rule.nodes[c] * h(e), Side::middle}]]
              TESTS_OF convergence
              MUST_FAIL LobattoLoads.HaveOrder2PWithTorquesThatVaryInTime
                        LobattoLoads.HaveOrder2PWithAllOfThemOnTwoBodies)

# Phi from the gradient at the node alone, not from the mean of both ends: right for linear rows only.
livens_mutant(NAME constraint_without_mean_gradient
              FILE dynamics/rows/row_tables.cpp
              OLD [[sum += (g_from[12 * side + a + i] + g_to[12 * side + a + i]) * d[a + i];]]
              NEW [[sum += 2 * g_to[12 * side + a + i] * d[a + i];]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.AgreesWithNewtonOnRandomMechanisms)
livens_mutant(NAME violations_not_projected_in_lanes
              FILE spacetime/elements/lane_kernel.h
              RECOMPILE spacetime/elements/lanes_sse2.cpp
              OLD [[multiply(p, G, v.step, v.violations, v.work);]]
              NEW [[multiply(p, G, v.step, nullptr, v.work);]]
              TESTS_OF conservation
              MUST_FAIL Lobatto.HoldsConstraintsAtNodesOverTenSeconds Lobatto.KeepsPinsTogetherAndRodsLong)

# Turns in axes that run ahead of the body instead of behind: the motion is right, by more steps.
livens_mutant(NAME axes_that_run_ahead
              FILE dynamics/lanes/row_sums.cpp
              OLD [[= -determinant(spin) *]]
              NEW [[= determinant(spin) *]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.GyroscopicTermsCostNoSteps)

# A load that comes later finds the mechanism as it was solved without it.
livens_mutant(NAME load_comes_unnoticed
              FILE multibody/model.cpp
              OLD [[    loads_.push_back(std::move(load));
    changed();]]
              NEW [[    loads_.push_back(std::move(load));]]
              TESTS_OF unit_spacetime
              MUST_FAIL Solve.ChangesOfAModelThatWasSolvedCount)

# One start taken for another that was closed before.
livens_mutant(NAME any_start_is_the_last
              FILE dynamics/start/prepared.cpp
              OLD [[same(a.X, b.X) &&]]
              NEW [[true &&]]
              TESTS_OF unit_spacetime
              MUST_FAIL Solve.EveryStartIsCheckedAndClosed)

# Angles followed from node to node by increments since the first node of the element.
livens_mutant(NAME turns_of_an_element
              FILE spacetime/nodal/node_violations.cpp
              OLD [[work[i] = B > 1 ? step[i] - dX(e, B - 1)[i] : step[i];]]
              NEW [[work[i] = step[i];]]
              TESTS_OF convergence
              MUST_FAIL Couplings.AnElementMayTurnByMoreThanAHalf)

# Nodes in positions where the joints lose rank are taken as they come.
livens_mutant(NAME nodes_in_singular_positions
              FILE spacetime/nodal/element_checks.cpp
              OLD [[constexpr double least = 1e-2;]]
              NEW [[constexpr double least = 0;]]
              TESTS_OF convergence
              MUST_FAIL SingularPositions.NoElementEndsThere SingularPositions.NoInnerNodeLiesThere)

# Of a node that two elements share the whole impulse is given to the second.
livens_mutant(NAME shared_impulse_given_twice
              FILE spacetime/nodal/element_end.cpp
              OLD [[weight * end_lambda_[system]]
              NEW [[0 * weight * end_lambda_[system]]
              TESTS_OF convergence
              MUST_FAIL LobattoWindows.OfAnyLengthGiveTheMarch LobattoEnds.HaveOrder2P)

# Reflections that lead with whichever entry comes next: directions across the plane mix with those in it.
livens_mutant(NAME reflections_without_choice
              FILE solvers/orthogonal_basis.cpp
              OLD [[reflections_[j].lead = best;]]
              NEW [[reflections_[j].lead = j;]]
              TESTS_OF conservation
              MUST_FAIL Lobatto.KeepsPlanarMotionsPlanarByNewtonToo)

# What a factorisation came to before it met a pivot that is not positive taken for the whole.
livens_mutant(NAME cholesky_of_any_matrix
              FILE solvers/factors.cpp
              OLD [[if (factor.info() != Eigen::Success) return all_nan(A.rows, A.cols);]]
              NEW [[if (factor.info() == Eigen::InvalidInput) return all_nan(A.rows, A.cols);]]
              TESTS_OF unit_solvers
              MUST_FAIL CholeskyFactor.WantsAPositiveMatrix)

# --- Radau points

# The momentum at the start shared out by the weights: right for degree 1 only.
livens_mutant(NAME radau_momentum_by_weights
              FILE spacetime/elements/rule.cpp
              OLD [[rule.c[a] = static_cast<double>(-w * rule.D[a * n]);]]
              NEW [[rule.c[a] = static_cast<double>(w);]]
              TESTS_OF convergence
              MUST_FAIL Radau.ConvergesWithOrder2PLess1OnTheFreeBox Radau.FollowsAStiffElasticPendulum)

# The jump where the polynomial meets the velocity.
livens_mutant(NAME radau_jump_at_the_end
              FILE diagnostics/velocity_jump.cpp
              OLD [[const bool at_start = motion.X.points == Points::radau;]]
              NEW [[const bool at_start = false;]]
              TESTS_OF convergence
              MUST_FAIL Radau.TellsTheErrorOfAnElementByItsVelocityJump)

# The fastest damper of all bodies taken for that of every vibration.
livens_mutant(NAME damper_of_another_body
              FILE spacetime/accuracy/shared_errors.cpp
              OLD [[one.rate < one.decay)]]
              NEW [[one.rate < highest_frequencies(model, motion.at_end(end)).dampers.rate)]]
              TESTS_OF convergence
              MUST_FAIL RadauEstimate.TellsAVibrationBesideAStrongDamper)

# The energy of a motion that damps not looked at at all.
livens_mutant(NAME radau_blow_up_hidden
              FILE diagnostics/balance.cpp
              OLD [[risen_ = sum < 0 ? 0 : sum;]]
              NEW [[risen_ = 0 * sum;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Verdict.OfEnergyThatRadauGainsIsSuspect)

# What bears a preload taken for what lets go.
livens_mutant(NAME frequency_of_a_preload_reversed
              FILE statics/small_motions.cpp
              OLD [[-congruence(maps_[b], K)]]
              NEW [[congruence(maps_[b], K)]]
              TESTS_OF unit_statics
              MUST_FAIL Frequencies.OfAPreloadThatABodyBears)

# Rigidity's part of the stiffness forgotten where moments are balanced.
livens_mutant(NAME stiffness_without_geometric_term
              FILE statics/small_motions.cpp
              OLD [[twist::add_geometric(state_.X.data() + 12 * b, r.data() + 12 * b, K.data(), 6);]]
              NEW [[twist::add_geometric(state_.X.data() + 12 * b, r.data() + 12 * b, K.data(), 6), K = {};]]
              TESTS_OF unit_statics
              MUST_FAIL Linearisation.IsThatOfDifferencesOfAccelerations)

# Newton's own steps, which climb to the upright pendulum as well.
livens_mutant(NAME equilibrium_by_newton_alone
              FILE statics/equilibrium.cpp
              OLD [[divisor[i] = mu < 0 ? std::copysign(size, k) : size + mu;]]
              NEW [[divisor[i] = std::copysign(size, k);]]
              TESTS_OF unit_statics
              MUST_FAIL Equilibrium.OfAPendulumIsTheHangingOneFromAnywhere)

# The skew part of a stiffness lost.
livens_mutant(NAME stiffness_made_symmetric
              FILE statics/linearisation.cpp
              OLD [[linear.K = by_rows(K);]]
              NEW [[linear.K = by_rows(symmetric_part(K));]]
              TESTS_OF unit_statics
              MUST_FAIL Linearisation.OfAFollowerForceIsNotSymmetric)

# --- the paper's elements

# Multipliers without their geometric stiffness: Newton would still converge, slowly.
livens_mutant(NAME mixed_without_geometric_stiffness
              FILE spacetime/mixed/tangent.cpp
              OLD [[entries.add(row + entry.coordinate_i, X + entry.coordinate_j, K[entry.row] * entry.value);]]
              NEW [[entries.add(row + entry.coordinate_i, X + entry.coordinate_j, 0 * K[entry.row]);]]
              TESTS_OF unit_spacetime
              MUST_FAIL AllPairings/MixedEquations.HaveTheMatrixOfTheirResidual/NaturalEqualX0P0
                        AllPairings/MixedEquations.HaveTheMatrixOfTheirResidual/StrongLowerXTPT)

# A load that shows a new entry of its tangent is not noticed: the matrix keeps a pattern without it.
livens_mutant(NAME mixed_pattern_never_grows
              FILE spacetime/mixed/element_sums.cpp
              OLD [[block.seen.set(static_cast<std::size_t>(i));]]
              NEW [[static_cast<void>(block.seen);]]
              TESTS_OF unit_spacetime
              MUST_FAIL MixedEquationsPattern.GrowsWhenALoadBeginsToAct)

# Half of the momentum at an end: Hamilton's law of varying action with a wrong boundary term.
livens_mutant(NAME mixed_wrong_boundary_term
              FILE spacetime/mixed/equations.cpp
              OLD [[r[row + i] += at_end ? p[i] : -p[i];]]
              NEW [[r[row + i] += 0.5 * (at_end ? p[i] : -p[i]);]]
              TESTS_OF conservation
              MUST_FAIL MixedMomentum.BalancesOverBlocksByTheDiagnosticsOfAnyMotion
                        MixedConditions.AtTheEndLeadBackToTheStart)

# The end multiplier tied with a wrong sign: every degree falls back.
livens_mutant(NAME mixed_wrong_tie
              FILE spacetime/mixed/fields.cpp
              OLD [[tie.terms.emplace_back(first + a, -derivative[a] / derivative[frozen - first]);]]
              NEW [[tie.terms.emplace_back(first + a, derivative[a] / derivative[frozen - first]);]]
              TESTS_OF convergence
              MUST_FAIL FreeBox/MixedOrders.AreThoseMeasured/Quartic FreeBox/MixedOrders.AreThoseMeasured/Sextic)

# Multipliers that go on smoothly where a load jumps: orders above 4 are lost.
livens_mutant(NAME mixed_multipliers_not_torn
              FILE spacetime/mixed/window.cpp
              OLD [[if (is_break && space.first(e)]]
              NEW [[if (!is_break && space.first(e)]]
              TESTS_OF convergence
              MUST_FAIL MixedJumps.InsideABlockCostNoOrder)

# A block that begins with the momentum the last one began with.
livens_mutant(NAME mixed_momentum_not_handed_on
              FILE spacetime/mixed/window.cpp
              OLD [[end.P = block_->equations().end_momentum(block_->fields(), !backwards);]]
              NEW [[end.P = block_->equations().end_momentum(block_->fields(), backwards);]]
              TESTS_OF conservation
              MUST_FAIL MixedMomentum.BalancesOverBlocksByTheDiagnosticsOfAnyMotion
                        MixedConditions.AtTheEndLeadBackToTheStart)

# --- diagnostics

# Every step taken as long as the first: where elements are uneven, velocities of a smooth motion alternate.
livens_mutant(NAME zigzag_of_equal_steps
              FILE diagnostics/zigzag.cpp
              OLD [[const double step = motion.mesh.length(e) / n;]]
              NEW [[const double step = motion.mesh.length(0) / n;]]
              TESTS_OF unit_diagnostics
              MUST_FAIL Zigzag.DoesNotMindUnevenElements)

# Work supplied counted as lost.
livens_mutant(NAME work_with_the_wrong_sign
              FILE diagnostics/balance.cpp
              OLD [[std::abs(piece.energy.back() - start_.energy - total_.work)]]
              NEW [[std::abs(piece.energy.back() - start_.energy + total_.work)]]
              TESTS_OF unit_diagnostics
              MUST_FAIL Balance.CountsTheWorkOfADamperAndTheEnergyOfASpring)

# A piece of the balance that begins at its own start, not at that of the motion.
livens_mutant(NAME balance_of_a_piece
              FILE diagnostics/balance.cpp
              OLD [[        if (end_ == 0)]]
              NEW [[        if (piece.t.size() == 1)]]
              TESTS_OF unit_diagnostics
              MUST_FAIL Balance.InPiecesIsThatOfTheWhole)

# Rows that are linear pull twice as much and are off by another amount.
livens_mutant(NAME linear_rows_in_lanes
              FILE diagnostics/detail/point_tables.cpp
              OLD [[entries_.push_back({number + i, B[i]});]]
              NEW [[entries_.push_back({number + i, 2 * B[i]});]]
              TESTS_OF unit_diagnostics
              MUST_FAIL Pass.SuppliesWhatLoadsAndRowsDo Pass.FindsViolationsOfEveryNode)
# What was asked of one point alone taken for all that stand beside it.
livens_mutant(NAME one_lane_for_all
              FILE diagnostics/detail/motion_pass.cpp
              OLD [[supply_at(of_rows, lane, batch.others(lane))]]
              NEW [[supply_at(of_rows, lane, batch.others(0))]]
              TESTS_OF unit_diagnostics
              MUST_FAIL Pass.SuppliesWhatLoadsAndRowsDo)
# Integrals by rules that are not exact.
livens_mutant(NAME integrals_of_few_points
              FILE diagnostics/detail/motion_pass.cpp
              OLD [[motion.gauss_points >= motion.X.degree ||]]
              NEW [[motion.gauss_points > 0 ||]]
              TESTS_OF unit_diagnostics
              MUST_FAIL Pass.IntegratesAsGaussRulesDo)
# Spins about one axis alone.
livens_mutant(NAME spins_of_one_axis
              FILE diagnostics/detail/alternation.cpp
              OLD [[if (!(m(k, k) > level)) break;]]
              NEW [[if (rank == 1 || !(m(k, k) > level)) break;]]
              TESTS_OF unit_diagnostics
              MUST_FAIL Pass.AlternatesAsItsIncrementsDo)
# Least reactions of the instant that was first asked for.
livens_mutant(NAME least_reactions_of_another_end
              FILE diagnostics/joint_samples.cpp
              OLD [[if (parts_->least_end == end)]]
              NEW [[if (parts_->least_end >= 0)]]
              TESTS_OF unit_diagnostics
              MUST_FAIL JointSampler.IsSampleJointsAtOneInstantAfterTheOther)

# --- stepping

# Not quite the middle: order 1.
livens_mutant(NAME midpoint_off_the_middle
              FILE stepping/step_equations.cpp
              OLD [[rule == SteppingRule::midpoint ? 0.5 : 1.0]]
              NEW [[rule == SteppingRule::midpoint ? 0.51 : 1.0]]
              TESTS_OF unit_stepping
              MUST_FAIL Stepping.FreeTopConvergesWithTheRulesOrder
                        Stepping.MidpointKeepsTheEnergyAndEndpointLosesIt)

# The tangent without the part of loads that depend on velocities: the answer stays.
livens_mutant(NAME stepping_without_damping_in_the_tangent
              FILE stepping/step_equations.cpp
              OLD [=[a_ * T.X[s][w] + (1 / start.h) * T.V[s][w]]=]
              NEW [=[a_ * T.X[s][w] + (0 / start.h) * T.V[s][w]]=]
              TESTS_OF unit_stepping
              MUST_FAIL */StepTangent.MatchesDifferences/*)

# --- files

# A checksum that is there, whatever it says.
livens_mutant(NAME checksum_not_compared
              FILE io/results/classic_netcdf_read.cpp
              OLD [[if (stored == nullptr || *stored != AttributeValue(checksum.text()))]]
              NEW [[if (stored == nullptr)]]
              TESTS_OF unit_io
              MUST_FAIL Results.EveryFlippedBitIsSeen)

# A variable that ends behind the file.
livens_mutant(NAME sizes_believed
              FILE io/results/classic_netcdf_read.cpp
              OLD [[v.begin > source_.size - v.n_bytes)]]
              NEW [[v.begin > source_.size)]]
              TESTS_OF unit_io
              MUST_FAIL Results.EveryTruncationIsToldAsOne)

# A link replaced instead of what it stands for.
livens_mutant(NAME links_replaced
              FILE io/results/atomic_file.cpp
              OLD [[    target_ = followed(file);]]
              NEW [[    target_ = file;]]
              TESTS_OF unit_io
              MUST_FAIL Results.LinksStayAndRightsAreKept)

# --- the program

# Temporaries of others that still write, removed.
livens_mutant(NAME temporaries_without_locks
              FILE io/results/atomic_file.cpp
              OLD [[if (found.number() < 0 || ::flock(found.number(), LOCK_EX | LOCK_NB) != 0) return;]]
              NEW [[if (found.number() < 0) return;]]
              TESTS_OF livens
              MUST_FAIL program_test.Signals.test_temporaries_of_the_dead_are_removed_and_no_others)

# A run that is suspect reported as one that is not.
livens_mutant(NAME suspect_is_fine
              FILE apps/livens/solve.cpp
              OLD [[report.reached_end() ? exit_suspect : exit_not_converged]]
              NEW [[report.reached_end() ? exit_ok : exit_not_converged]]
              TESTS_OF livens
              MUST_FAIL program_test.Solve.test_midpoint_and_endpoint)

# The same file by another name.
livens_mutant(NAME names_for_files
              FILE apps/livens/places.cpp
              OLD [[    if (same_file(file, other)) refuse(file, why);]]
              NEW [[    if (file == other) refuse(file, why);]]
              TESTS_OF livens
              MUST_FAIL strangers_test.NothingIsLost.test_inputs_whatever_is_forced)

# Memory asked for and not looked at.
livens_mutant(NAME memory_unlimited
              FILE apps/livens/memory.cpp
              OLD [[if (all <= left) return;]]
              NEW [[return;]]
              TESTS_OF livens
              MUST_FAIL program_test.Files.test_memory_is_checked_before_solving)

# Integrals about the origin: right for parts that lie there.
livens_mutant(NAME moments_about_origin
              FILE geometry/moments.cpp
              OLD [[return 0.5 * low + 0.5 * high;   // the sum might overflow]]
              NEW [[return {};]]
              TESTS_OF unit_geometry
              MUST_FAIL Moments.OfABoxFarAwayLoseNothing)

# Pieces that lie in each other count twice.
livens_mutant(NAME pieces_unseen
              FILE geometry/pieces.cpp
              OLD [[if (piece.depth == (piece.volume > 0 ? 0 : 1)) continue;]]
              NEW [[if (piece.volume != 0) continue;]]
              TESTS_OF unit_geometry
              MUST_FAIL Soundness.NamesWhatIsInsideOutAndTurnsIt)

# Neighbours that share one corner are taken for apart.
livens_mutant(NAME contacts_of_neighbours
              FILE geometry/contacts.cpp
              OLD [[if (n_shared_ == 3) return true;]]
              NEW [[if (n_shared_ >= 1) return true;]]
              TESTS_OF unit_geometry
              MUST_FAIL Soundness.NamesWhereASurfaceMeetsItself)

# Faces round a point that fold back are taken for neighbours that lie side by side.
livens_mutant(NAME contacts_of_fans
              FILE geometry/rings.cpp
              OLD [[if (bits == 0 && goes_round_once(axis)) bits = 64;]]
              NEW [[if (bits == 0) bits = 64;]]
              TESTS_OF unit_geometry
              MUST_FAIL Soundness.NamesWhereASurfaceMeetsItself)

# A sheet that leaves the box above or below, and may come back, is taken for one that stays.
livens_mutant(NAME contacts_beyond_the_box
              FILE geometry/sheets.cpp
              OLD [[if (any(met & bad)) return false;]]
              NEW [[if (any(met & bad) && n_above_ > 1) return false;]]
              TESTS_OF unit_geometry
              MUST_FAIL Contacts.LONG_OfSurfacesWithASpikeAreThoseOfAllPairs)

# Several sheets over one place are taken for one: they may cross.
livens_mutant(NAME contacts_of_two_sheets
              FILE geometry/sheets.cpp
              OLD [[return go(1) && n_above_ == 1;]]
              NEW [[return go(1);]]
              TESTS_OF unit_geometry
              MUST_FAIL Contacts.OfSheetsThatLieCloseAreWhereADomeComesThrough)

# A pressure that pulls.
livens_mutant(NAME pressure_sign
              FILE multibody/loads/pressure.cpp
              OLD [[F[0] = -1. * (directors]]
              NEW [[F[0] = 1. * (directors]]
              TESTS_OF unit_multibody
              MUST_FAIL SurfaceLoads.PressurePushesAgainstTheNormalAtTheMiddleOfASide)

# A pressure that is the same at all depths of a body, as at its reference point.
livens_mutant(NAME pressure_by_depth
              FILE multibody/loads/pressure.cpp
              OLD [[q[0] += value(arguments.at).value;]]
              NEW [[q = Vector4{q[0] + value(arguments.at).value, 0, 0, 0};]]
              TESTS_OF unit_multibody
              MUST_FAIL SurfaceLoads.PressureThatGrowsWithDepthBearsWhatIsDisplaced)

# A link that leads out of the scenario's folder.
livens_mutant(NAME mesh_by_a_link
              FILE io/scenario/bodies/meshes.cpp
              OLD [[if (!is_inside(file, folder))]]
              NEW [[if (file.empty())]]
              TESTS_OF unit_io
              MUST_FAIL MeshScenario.RefusesWhatItMustNotRead)

# The volume of turning taken as if all of it were at the rim: right of what is hollow.
livens_mutant(NAME round_solid_at_its_rim
              FILE geometry/primitive_solid.cpp
              OLD [[factor * solid_.bore, factor * wide}]]
              NEW [[factor * (solid_.bore + wide), 0}]]
              TESTS_OF unit_geometry
              MUST_FAIL PrimitiveSolid.OfConstantDensityHasItsClosedForms
                        PrimitiveSolid.OfOtherFieldsAgreesWithSciPy)

# A part with a density of its own weighed by the body's as well: right where that is 1.
livens_mutant(NAME field_times_density
              FILE io/scenario/bodies/shapes.cpp
              OLD [[section.has("density_field") ? factor : density * factor]]
              NEW [[density * factor]]
              TESTS_OF unit_io
              MUST_FAIL SolidScenario.PartsHaveDensitiesThatAreFields)

# A page served to the whole network instead of this machine.
livens_mutant(NAME view_everywhere
              FILE apps/livens/view.cpp
              OLD [[htonl(INADDR_LOOPBACK)]]
              NEW [[htonl(INADDR_ANY)]]
              TESTS_OF livens
              MUST_FAIL report_test.View.test_serves_the_page_here_and_nothing_else)

# Pages of other sites may ask for it by a name of their own.
livens_mutant(NAME view_any_host
              FILE apps/livens/visitors.cpp
              OLD [[is_here = asks_this_host(head_, served.port)]]
              NEW [[is_here = true]]
              TESTS_OF livens
              MUST_FAIL report_test.View.test_serves_the_page_here_and_nothing_else)

# A file that is gone between two versions of it is told as an error.
livens_mutant(NAME watch_gap
              FILE apps/livens/watched_files.cpp
              OLD [[(is_gone ? Clock::duration(patience) : quiet)]]
              NEW [[quiet * (is_gone ? 1 : 1)]]
              TESTS_OF livens
              MUST_FAIL watch_test.Watching.test_editors_that_save_by_rename_or_leave_a_gap)

# A report that may ask for more than it holds.
livens_mutant(NAME report_may_connect
              FILE io/report/page.cpp
              OLD [[page_of(first.title, "", "", {&first})]]
              NEW [[page_of(first.title, "", "; connect-src 'self'", {&first})]]
              TESTS_OF livens
              MUST_FAIL report_test.Report.test_loads_nothing_and_admits_its_own_script_alone)

# Directors that are not orthonormal as quaternions: a picture of another motion.
livens_mutant(NAME report_free_directors
              FILE io/report/poses.cpp
              OLD [[orthonormal = 1e-14]]
              NEW [[orthonormal = 1e-2]]
              TESTS_OF livens
              MUST_FAIL report_test.Report.test_directors_that_are_free_are_kept_whole)

# The attracting point, which is the world's, sent through the axes of a skew body.
livens_mutant(NAME attraction_in_the_body
              FILE io/scenario/loads/load_kinds.cpp
              OLD [[{p.section.vector("point"), p.section.number("mu")]]
              NEW [[{point_of(p), p.section.number("mu")]]
              TESTS_OF livens
              MUST_FAIL skew_test.Skew.test_places_of_the_body_and_of_the_world)

# All of the potential in axes of the body: forces of mu m / r on the directors, which have to cancel.
livens_mutant(NAME attraction_pulls_at_directors
              FILE multibody/loads/attraction.cpp
              OLD [[for (const PairForm& row : coincidence_rows(world, there, body, centre, 1)) add(row);]]
              NEW [[for (int k = 0; k < 3; ++k) {
        Vector3 unit{};
        unit[k] = 1;
        add(plane_row(body, direction(unit), centre, world, there, 0, 1));
    }]]
              TESTS_OF unit_multibody
              MUST_FAIL Attraction.PullsAtTheDirectorsByItsGradientAlone)

# tr J left out: the couple is right, and the pull is not.
livens_mutant(NAME attraction_without_trace
              FILE multibody/loads/attraction.cpp
              OLD [[V.add(-0.5 * mu * trace(J), y, -3, 1, {}, {});]]
              NEW [[V.add(-0.0 * mu * trace(J), y, -3, 1, {}, {});]]
              TESTS_OF unit_multibody
              MUST_FAIL Attraction.WithItsGradientIsThatOfABodysParts)

# Rounding of a large load taken for a vibration.
livens_mutant(NAME frequency_of_rounding
              FILE statics/frequencies.cpp
              OLD [[return value <= rounding * size;]]
              NEW [[return value <= 0 * rounding * size;]]
              TESTS_OF unit_statics
              MUST_FAIL Frequencies.AreNotMadeOfTheRoundingOfLargeLoads)

# A bound of vibrations that leaves half of each term out.
livens_mutant(NAME vibrations_beyond_their_bound
              FILE statics/frequencies.cpp
              OLD [[const double half = 0.5 * norm(t.K);]]
              NEW [[const double half = 0.25 * norm(t.K);]]
              TESTS_OF unit_statics
              MUST_FAIL Frequencies.FromARateOnAreTheFastestOfAll)

# A driven angle as the sine of what it is off: beyond a quarter of a turn that leads away.
livens_mutant(NAME driven_angle_by_its_sine
              FILE dynamics/rows/reach.cpp
              OLD [[is_driven_angle(joint) ? by_angle(joint) : joint]]
              NEW [[joint]]
              TESTS_OF unit_dynamics
              MUST_FAIL ConsistentStart.LeadsADrivenAngleBackFromAnywhere)

# One try: bodies that stand at one place are told that they cannot be joined.
livens_mutant(NAME one_start_alone
              FILE dynamics/rows/reach.cpp
              OLD [[for (const double size : disturbances) {]]
              NEW [[for (const double size : {0.0}) {]]
              TESTS_OF unit_dynamics
              MUST_FAIL ConsistentStart.ClosesBodiesThatStandAtOnePlace)

# atan2(y, x) taken to jump wherever y passes zero.
livens_mutant(NAME cut_on_both_sides
              FILE time/expression_events.cpp
              OLD [[return step.operation != Operation::arc_tangent || !(values[step.second].value > 0);]]
              NEW [[return step.operation != Operation::arc_tangent || values[step.second].value > -1e9;]]
              TESTS_OF unit_time
              MUST_FAIL Expression.KnowsWhereTimeAloneMakesItJumpOrBend)

# Rounding measured by what is stated alone: at rest everything breaks a joint.
livens_mutant(NAME rounding_is_no_rest
              FILE dynamics/start/consistent_start.cpp
              OLD [[if (least > speed) fault]]
              NEW [[if (least > 1e99) fault]]
              TESTS_OF unit_dynamics
              MUST_FAIL StartSpeeds.OfRoundingAreRest)

# Momenta that were stated and are not there: nobody looks.
livens_mutant(NAME ends_not_compared
              FILE spacetime/accuracy/met_ends.cpp
              OLD [[if (c.off <= 1 || (worst]]
              NEW [[if (c.off <= 1e99 || (worst]]
              TESTS_OF convergence
              MUST_FAIL LobattoEnds.MomentaThatJointsDoNotLetTheMotionHaveAreSuspect)

# An angle behind its hinge by directions across the axis that nobody stated.
livens_mutant(NAME angle_apart_by_one_direction
              FILE multibody/model.cpp
              OLD [[if (has_events && !one.apart.forms.empty())]]
              NEW [[if (false)]]
              TESTS_OF unit_multibody
              MUST_FAIL Joints.AnAngleThatLetsGoNeedsNoDirectionsAcrossItsAxis)

# Neighbours that part until they bend: what they bend by grows from turn to turn of a tumbling body.
livens_mutant(NAME growth_bends
              FILE spacetime/accuracy/neighbours.cpp
              OLD [[beside_two{1e-5, 3e-5, 1e-4}]]
              NEW [[beside_two{1e-5, 3e-2, 1e-1}]]
              TESTS_OF convergence
              MUST_FAIL Horizon.GrowthOfATumblingBodyIsThatOfTheMotionWhateverTheElements)

# One-sided differences whatever they have grown to: of second order.
livens_mutant(NAME growth_one_sided
              FILE spacetime/accuracy/neighbours.cpp
              OLD [[constexpr double most_of_one = 100, share_of_one = 1e-2;]]
              NEW [[constexpr double most_of_one = 1e30, share_of_one = 1e60;]]
              TESTS_OF convergence
              MUST_FAIL Horizon.GrowthOfATumblingBodyIsThatOfTheMotionWhateverTheElements)

# Both sides from the start on: right, and twice the work.
livens_mutant(NAME growth_always_two_sided
              FILE spacetime/accuracy/neighbours.cpp
              OLD [[has_two_(most_alone_ < 1)]]
              NEW [[has_two_(most_alone_ > 1)]]
              TESTS_OF convergence
              MUST_FAIL Horizon.CalmMotionsHaveOneNeighbour)

# What was made smaller on the way is forgotten.
livens_mutant(NAME growth_forgets
              FILE spacetime/accuracy/neighbours.cpp
              OLD [[one.so_far /= share;]]
              NEW [[one.so_far /= 1;]]
              TESTS_OF convergence
              MUST_FAIL Horizon.GrowthOnAnUnstableRestIsItsExponential
                        Horizon.OfTheDoublePendulumsIsWhereTwoIntegrationsPart)

# Perturbations across what turns a body alone: a steady spin is told not to grow.
livens_mutant(NAME growth_across_alone
              FILE spacetime/accuracy/perturbations.cpp
              OLD [[std::sqrt(2.0) * across(spin)]]
              NEW [[0.0 * across(spin)]]
              TESTS_OF convergence
              MUST_FAIL Horizon.SteadySpinOfABodyThatIsHeldGrowsByItsAngle)

# Rounding is thought to leave the plane that all numbers are in.
livens_mutant(NAME rounding_across_a_plane
              FILE spacetime/accuracy/perturbations.cpp
              OLD [[along[i] = !zeros[i];]]
              NEW [[along[i] = true;]]
              TESTS_OF convergence
              MUST_FAIL LightBetweenRods.RoundingDoesNotLeaveAPlaneOfTheAxes)

# Rounding is told to stay in any plane.
livens_mutant(NAME rounding_forgotten
              FILE spacetime/accuracy/growth.cpp
              OLD [[of_rounding.factors.size() ? of_rounding]]
              NEW [[of_rounding.factors.size() ? 1e-6 * of_rounding]]
              TESTS_OF convergence
              MUST_FAIL Horizon.ARefusalNamesWhatGrowsAndSaysThatTheMotionIsWhole
                        Horizon.RoundingsOnTheWayAreTold)

# Numbers are rounded at the start, and never again.
livens_mutant(NAME rounded_once
              FILE spacetime/accuracy/neighbours.cpp
              OLD [[std::sqrt(n) / one.so_far)]]
              NEW [[0 * std::sqrt(n) / one.so_far)]]
              TESTS_OF convergence
              MUST_FAIL Horizon.RoundingsOnTheWayAreTold)

# Neighbours on one side, whatever shrinks and grows again: their errors grow from turn to turn.
livens_mutant(NAME growth_never_careful
              FILE spacetime/accuracy/neighbours.cpp
              OLD [[constexpr double most_folded = 100;]]
              NEW [[constexpr double most_folded = 1e30;]]
              TESTS_OF convergence
              MUST_FAIL Horizon.GrowthOfATumblingBodyIsThatOfTheMotionWhateverTheElements
                        Horizon.WhatTurnsOverHasNeighboursOnBothSides)

# The first perturbation alone, whatever it may have missed.
livens_mutant(NAME growth_of_one_direction
              FILE spacetime/accuracy/growth.cpp
              OLD [[constexpr double missed = 30;]]
              NEW [[constexpr double missed = 0;]]
              TESTS_OF convergence
              MUST_FAIL Horizon.WhatGrowsHasTwoNeighbours)

# Neighbours' bodies are moved by what their centres of mass move by.
livens_mutant(NAME neighbours_by_centres
              FILE spacetime/accuracy/neighbour_elements.cpp
              OLD [[for (int i = 0; i < 3; ++i) d[i] -=]]
              NEW [[for (int i = 0; i < 0; ++i) d[i] -=]]
              TESTS_OF convergence
              MUST_FAIL Horizon.ElementsOfNeighboursTellWhatWindowsDo)

# The first try believes that a motion stays as slow as it begins.
livens_mutant(NAME first_try_from_rest
              FILE spacetime/accuracy/accuracy.cpp
              OLD [[constexpr double seen_by = 2;]]
              NEW [[constexpr double seen_by = 1e9;]]
              TESTS_OF convergence
              MUST_FAIL Accuracy.TheFirstTryKnowsHowFastWeightMakesAMotionThatBeginsAtRest)

# Nobody looks at the energy of stiff springs that turn: the march goes on until it dies.
livens_mutant(NAME turning_springs_unwatched
              FILE spacetime/march/march.cpp
              OLD [[options_.watch && (outcome.factorisations > 0 || outcome.took_slopes)]]
              NEW [[options_.watch && outcome.factorisations < 0]]
              TESTS_OF conservation
              MUST_FAIL TurningSprings.EndTheMarchByNameBeforeItDies)

# Another bound: elements of the length that is advised lose the motion again.
livens_mutant(NAME turning_springs_without_bound
              FILE spacetime/accuracy/turning_springs.cpp
              OLD [[(degree + 1) * (2 * degree - 1)]]
              NEW [[(degree + 1) * (2 * degree + 8)]]
              TESTS_OF conservation
              MUST_FAIL TurningSprings.AdviseElementsThatAreShortEnough)

# Velocities that vibrate turn the forms as well: springs that are drawn change the stiffness across them.
livens_mutant(NAME turning_by_vibration
              FILE statics/turning_vibrations.cpp
              OLD [[springs.moved(springs.slow_part(springs.velocity(), n_slow))]]
              NEW [[springs.moved(springs.velocity())]]
              TESTS_OF unit_statics
              MUST_FAIL TurningVibrations.LeaveOutVelocitiesThatVibrate)

# Two dimensions of one name: counts come from one of them, divisors from the other.
livens_mutant(NAME names_twice
              FILE io/results/classic_netcdf_read.cpp
              OLD [[if (twice != names.end())]]
              NEW [[if (names.empty())]]
              TESTS_OF unit_io
              MUST_FAIL CraftedFiles.TwoOfOneNameAreRefused)

# A dimension of length 0 is read as if it were any other.
livens_mutant(NAME width_of_zero
              FILE io/results/read.cpp
              OLD [[if (v != nullptr && v->n_values == 0)]]
              NEW [[if (v != nullptr && v->n_values == 1u << 31)]]
              TESTS_OF unit_io
              MUST_FAIL CraftedFiles.LengthsOfZeroAreRefusedWhereTheyAreRead)

# Variables may share bytes, and reading all of them takes as long as their product with the file.
livens_mutant(NAME variables_share_bytes
              FILE io/results/classic_netcdf_read.cpp
              OLD [[left -= v.n_bytes;]]
              NEW [[(void)left;]]
              TESTS_OF unit_io
              MUST_FAIL CraftedFiles.VariablesHaveNoByteInCommon)

# The motion may have fewer angles than the model's loads read.
livens_mutant(NAME angles_of_another_model
              FILE io/results/write.cpp
              OLD [[fits &= angles.empty() ||]]
              NEW [[fits &= true ||]]
              TESTS_OF unit_io
              MUST_FAIL CraftedFiles.AnglesOfLoadsAreThoseOfTheModel)

# Whatever stands there is replaced.
livens_mutant(NAME nothing_is_occupied
              FILE io/results/occupied.cpp
              OLD [[return !head.empty() && !is_own(head);]]
              NEW [[return !head.empty() && head.empty();]]
              TESTS_OF unit_io
              MUST_FAIL Results.OnlyWhatIsEmptyOrOfTheirKindMayBeReplaced)

# The meshes of a scenario forgotten among its inputs.
livens_mutant(NAME meshes_are_no_inputs
              FILE apps/livens/places.cpp
              OLD [[check_differs(file, mesh, "it is a mesh of the scenario");]]
              NEW [[(void)mesh;]]
              TESTS_OF livens
              MUST_FAIL strangers_test.NothingIsLost.test_inputs_whatever_is_forced)

# A host that is named twice, once rightly.
livens_mutant(NAME one_host_of_two
              FILE apps/livens/visitors.cpp
              OLD [[return n_hosts == 1 && is_this;]]
              NEW [[return is_this || n_hosts == 2;]]
              TESTS_OF livens
              MUST_FAIL report_test.View.test_names_of_fields_and_hosts_have_no_case)

# What came while a scenario was solved is replaced all the same.
livens_mutant(NAME place_looked_at_once
              FILE io/results/atomic_file.cpp
              OLD [[if (is_occupied(target_, is_own_))]]
              NEW [[if (false)]]
              TESTS_OF livens
              MUST_FAIL strangers_test.NothingIsLost.test_files_that_come_while_it_is_solved)

# As many dimensions as a file says.
livens_mutant(NAME ranks_believed
              FILE io/results/classic_netcdf_read.cpp
              OLD [[if (rank > most_dimensions)]]
              NEW [[if (rank > 1000 * most_dimensions)]]
              TESTS_OF unit_io
              MUST_FAIL CraftedFiles.RanksAndNamesAreBounded)

# What both ends take of memory, without their condition number.
livens_mutant(NAME both_ends_unstated
              FILE io/scenario/run/memory.cpp
              OLD [[(140 + 12 * p) * f * f + 200 * f + 500)]]
              NEW [[0 * f)]]
              TESTS_OF livens
              MUST_FAIL stop_test.MemoryStated.test_conditions_at_both_ends_are_in_what_check_says)

# Faces on both sides of a point count.
livens_mutant(NAME faces_before_the_point
              FILE geometry/depths.cpp
              OLD [[if (away * turn > 0) wound.behind += turn;]]
              NEW [[wound.behind += turn;]]
              TESTS_OF unit_geometry
              MUST_FAIL DepthsOf.PiecesAnywhereAreThoseOfSolidAngles)

# A line along an edge taken for one beside it.
livens_mutant(NAME lines_along_edges
              FILE geometry/depths.cpp
              OLD [[        wound.is_clear = false;]]
              NEW [[        wound.is_met = true;]]
              TESTS_OF unit_geometry
              MUST_FAIL DepthsOf.BlocksInAGridAreThoseOfSolidAngles)

# More pairs than are looked at taken for none that touch.
livens_mutant(NAME pairs_uncounted
              FILE geometry/contacts.cpp
              OLD [[if (!are_few) return {0, 0};]]
              NEW [[(void)are_few;]]
              TESTS_OF unit_geometry
              MUST_FAIL Nested.ShellsAreRefusedByTheirNumberInNoTime)

# Marks of writing direction taken for letters.
livens_mutant(NAME directions_are_letters
              FILE io/json.cpp
              OLD [[{0x2028, 0x202e},]]
              NEW [[{0x2028, 0x2029},]]
              TESTS_OF unit_io
              MUST_FAIL Invisible.CharactersAreKnownAndEscapedInJson)

# Nothing is ever doubted: a needle between two looks is flown through.
livens_mutant(NAME laws_undoubted
              FILE spacetime/nodal/laws/missed_moments.cpp
              OLD [[    double doubt = 0;
    for (std::size_t k = 0; k < m; ++k) {
        double steepest = 0, widest = 0;]]
              NEW [[    double doubt = 0;
    for (std::size_t k = 0; k < 0 * m; ++k) {
        double steepest = 0, widest = 0;]]
              TESTS_OF unit_spacetime
              MUST_FAIL InsideLaws.ANeedleIsFoundWhateverItsWidth
                        InsideLaws.WhatNeitherSolutionSeesIsInTheEstimate)

# What is seen of a law is integrated well, whatever its shape between the places.
livens_mutant(NAME integrals_unchecked
              FILE spacetime/nodal/laws/missed_moments.cpp
              OLD [[std::max(steepness_doubt(path, panel, seen), quadrature_doubt(path, rule, panel, seen))]]
              NEW [[std::max(steepness_doubt(path, panel, seen), 0 * quadrature_doubt(path, rule, panel, seen))]]
              TESTS_OF unit_spacetime
              MUST_FAIL InsideLaws.WhatIsSeenIsIntegratedToo)

# What the second solution does not see is forgotten.
livens_mutant(NAME unseen_forgotten
              FILE diagnostics/estimate.cpp
              OLD [[shifts_[b].rate += one.shift[b], shifts_[b].moment += one.shift[b] * since;]]
              NEW [[shifts_[b].rate += 0 * one.shift[b], shifts_[b].moment += 0 * since;]]
              TESTS_OF unit_spacetime
              MUST_FAIL InsideLaws.WhatNeitherSolutionSeesIsInTheEstimate)

# A loss that rounding hides is told by its root, at rest as well.
livens_mutant(NAME root_of_rounding
              FILE spacetime/accuracy/shared_errors.cpp
              OLD [[return is_hidden_ && root_ * width > jumps ? jumps / width : root_;]]
              NEW [[return is_hidden_ && jumps < 0 ? jumps / width : root_;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Verdict.OfRestOnSpringsIsNotTheRootOfRounding)

# What rounding may hide of a loss is taken for nothing.
livens_mutant(NAME hidden_loss_is_none
              FILE spacetime/accuracy/shared_errors.cpp
              OLD [[std::max(whole.energy_loss, hidden)]]
              NEW [[std::max(whole.energy_loss, 0 * hidden)]]
              TESTS_OF unit_spacetime
              MUST_FAIL Verdict.OfVibrationsWhoseEnergyIsRoundingIsNoLessThanTheyAre)

# Rows of a child that its parent moves do not go to the parent.
livens_mutant(NAME rows_stay_with_the_child
              FILE spacetime/nodal/condensed/element_factor.cpp
              OLD [[    functions_->add_from_left(gone.T.data(), of_T, own.of_ends.data(), sizes_.n_rows, above.of_ends.data(),
                              sizes_.n_rows);]]
              NEW [[    ]]
              TESTS_OF unit_spacetime
              MUST_FAIL LargeElements/InsideOfElements.IsEliminatedAlongJointsOfTrees/*)

# What rows of a parent have by its child is forgotten.
livens_mutant(NAME parents_do_not_feel_children
              FILE spacetime/nodal/condensed/element_factor.cpp
              OLD [[if (!own.of_parent.empty()) {]]
              NEW [[if (own.of_parent.size() == 1) {]]
              TESTS_OF unit_spacetime
              MUST_FAIL LargeElements/InsideOfElements.IsEliminatedAlongJointsOfTrees/*)

# Elements that move by themselves are eliminated along joints all the same.
livens_mutant(NAME growth_is_not_watched
              FILE spacetime/nodal/condensed/element_factor.cpp
              OLD [[constexpr double most_growth = 1e6;]]
              NEW [[constexpr double most_growth = 1e16;]]
              TESTS_OF unit_spacetime
              MUST_FAIL AlongJoints.TurnToDenseBlocksWhereAnElementMovesByItself)

# A guess of the start moves the zero of rotations.
livens_mutant(NAME rotations_count_from_the_guess
              FILE multibody/state_quantities.cpp
              OLD [[transpose(body.upright)]]
              NEW [[transpose(directors(body.X))]]
              TESTS_OF unit_io
              MUST_FAIL KnownComponents.OfRotationsCountFromWhereBodiesArePlaced)

# The classical rules and mixed judge themselves.
livens_mutant(NAME no_witness
              FILE spacetime/accuracy/estimate.cpp
              OLD [[method_(witness_of(method))]]
              NEW [[method_(method)]]
              TESTS_OF convergence
              MUST_FAIL Estimates.AreTheTrueErrorWithinAFactorOfThree)

# Opaque forces are not looked at beside the ends of elements.
livens_mutant(NAME ends_of_elements_unseen
              FILE spacetime/nodal/laws/missed_moments.cpp
              OLD [[constexpr double beside_moments[] = {1e-4, 1e-2};]]
              NEW [[constexpr double beside_moments[] = {1e-15, 1e-14};]]
              TESTS_OF unit_spacetime
              MUST_FAIL InsideLaws.ALayerAtTheStartIsSeenOfForcesThatAreOpaque)

# The slope of a product without one of its parts.
livens_mutant(NAME enclosed_product
              FILE time/expression_enclosures.cpp
              OLD [[a.slope * b.value + a.value * b.slope]]
              NEW [[a.slope * b.value]]
              TESTS_OF unit_time
              MUST_FAIL Expression.OverAWayEnclosesWhatItDoes)

# A product of symbols taken for linear: nobody looks at it.
livens_mutant(NAME products_are_linear
              FILE time/expression_enclosures.cpp
              OLD [[more < Kind::affine || std::min(a, b) == Kind::number ? more : Kind::other]]
              NEW [[more]]
              TESTS_OF unit_time
              MUST_FAIL Expression.KnowsWhetherItIsLinearInItsSymbols)

# Elements end in singular positions, where neither velocities nor reactions are determined.
livens_mutant(NAME ends_in_singular_positions
              FILE spacetime/march/partition.cpp
              OLD [[options_.direction * shift * length;]]
              NEW [[0 * shift * length;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Windows.EndsMoveOffSingularPositions)

# An accuracy that was not reached is called reached.
livens_mutant(NAME inaccurate_is_fine
              FILE spacetime/accuracy/until_accurate.cpp
              OLD [[report.status = SolveStatus::inaccurate;
    report.failed_at = motion]]
              NEW [[report.status = SolveStatus::converged;
    report.failed_at = motion]]
              TESTS_OF convergence
              MUST_FAIL Accuracy.SaysWhereItIsLost)

# Loads in lanes take places from the reference point, though lanes have centres of mass.
livens_mutant(NAME arms_about_the_reference_point
              FILE dynamics/lanes/load_program_arms.cpp
              OLD [[- arm.w[0] * tables.bodies]]
              NEW [[- 0 * tables.bodies]]
              TESTS_OF properties
              MUST_FAIL LoadKit/EveryLoad.Passes/spring_damper_spring_and_damper)

# Loads that record nothing are left out.
livens_mutant(NAME loads_without_a_tape_unseen
              FILE dynamics/lanes/load_lanes.cpp
              OLD [[if (program_->others().empty()) return;]]
              NEW [[return;]]
              TESTS_OF properties
              MUST_FAIL LoadKit/EveryLoad.Passes/force_function)

# Of products that sums take in, those that are taken off are added.
livens_mutant(NAME products_added
              FILE dynamics/lanes/load_program.cpp
              OLD [[const double sign = step.kind == TapeKind::minus ? -1 : 1;]]
              NEW [[const double sign = step.kind == TapeKind::minus ? 1 : 1;]]
              TESTS_OF properties
              MUST_FAIL LoadKit/EveryLoad.Passes/bushing_*)

# The last node has no share of the loads.
livens_mutant(NAME last_node_unloaded
              FILE spacetime/nodal/kernel/kernel_wrenches.cpp
              OLD [[        add(numbers, W, left, 1);]]
              NEW [[        add(numbers, W, F, W);]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.AgreesWithNewtonOnRandomMechanisms)

# Elements whose law is on the other side of a jump at their end are believed.
livens_mutant(NAME jumps_back_unseen
              FILE spacetime/nodal/laws/switching_points.cpp
              OLD [[constexpr double off = 0.1;]]
              NEW [[constexpr double off = 1e9;]]
              TESTS_OF reference
              MUST_FAIL Sliding.ForAShortTimeIsToldToo)

# A number that rounding moves about its place counts as passing it.
livens_mutant(NAME passages_by_rounding
              FILE spacetime/nodal/laws/watched_law.cpp
              OLD [[digits = 64 *]]
              NEW [[digits = 0 *]]
              TESTS_OF reference
              MUST_FAIL Sliding.RestsAtAKinkThatRoundingPasses)

# Nothing is ever near a bend.
livens_mutant(NAME guards_always_calm
              FILE spacetime/nodal/laws/calm_laws.cpp
              OLD [[constexpr double gaps_away = 2;]]
              NEW [[constexpr double gaps_away = -1e9;]]
              TESTS_OF reference
              MUST_FAIL Bends.AnyAccuracyIsReached)

# Looks in lanes do not tell the numbers between them, whose enclosures then are points.
livens_mutant(NAME looks_without_numbers
              FILE spacetime/nodal/laws/looks_in_lanes.cpp
              OLD [[sum += values[A * size + ]]
              NEW [[sum += 0 * values[A * size + ]]
              TESTS_OF reference
              MUST_FAIL Inside.LayersOfAnyWidthAreInTheEstimate
                        Inside.LawsAreFollowedToTheAccuracyThatIsTold)

# A limit holds a joint that leaves it faster than its spring follows.
livens_mutant(NAME limits_that_pull
              FILE multibody/loads/joint_spring.cpp
              OLD [[if (s <= 0 || g <= 0) return;]]
              NEW [[if (s <= 0) return;]]
              TESTS_OF unit_io
              MUST_FAIL JointLimits.NeverPullAndStoreWhatTheyTake)

# A joint that stands at a limit is thrown about by rounding.
livens_mutant(NAME limits_to_the_last_digit
              FILE multibody/loads/joint_spring.cpp
              OLD [[return 1e-12 * std::max(1.0, std::abs(limit));]]
              NEW [[return 0 * limit;]]
              TESTS_OF unit_io
              MUST_FAIL JointLimits.NeverPullAndStoreWhatTheyTake)

# What a limit dissipates is not told.
livens_mutant(NAME limits_without_loss
              FILE multibody/loads/joint_spring.cpp
              OLD [[return -stiffness * (std::max(guard(q), 0.0) - s) * outwards * q.rate;]]
              NEW [[return 0 * s;]]
              TESTS_OF properties
              MUST_FAIL LoadKit/EveryLoad.Passes/joint_spring_limits_of_an_angle)

# What hangs on a joint by others is left out of the inertia that its limits are made for.
livens_mutant(NAME limits_for_one_body
              FILE dynamics/instant/inertia_along.cpp
              OLD [[row.drives.empty(); }))]]
              NEW [[row.drives.empty(); }) && &joint == &model.joints()[0])]]
              TESTS_OF unit_io
              MUST_FAIL JointLimits.HaveTheirSpringsFromTheBodies)

# The damper of all turns knows two of its axes.
livens_mutant(NAME damper_of_two_axes
              FILE multibody/loads/relative_spin.cpp
              OLD [[for (int k = 0; k < 3; ++k) u[3 + k] += 0.5 * w[k];]]
              NEW [[for (int k = 0; k < 2; ++k) u[3 + k] += 0.5 * w[k];]]
              TESTS_OF unit_multibody
              MUST_FAIL RotationalDamper.TurnsAgainstTheRelativeAngularVelocity)

# The rate of a coordinate knows the motion of one body alone.
livens_mutant(NAME rates_of_tapes_by_one_factor
              FILE multibody/loads/load_coordinate_on_tape.cpp
              OLD [[add(sum, dot(tape.arm(side_u, u), tape.arm(side_v, v, true)));]]
              NEW [[;]]
              TESTS_OF properties
              MUST_FAIL LoadKit/EveryLoad.Passes/joint_spring_damper_about_an_axis)

# What bodies bear is not passed to those that they hang on.
livens_mutant(NAME what_a_child_bears_is_not_its_parents
              FILE spacetime/nodal/kernel/tree_tangent.cpp
              OLD [[add_from_b(above);]]
              NEW [[;]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.StiffLoadsAreSolvedWithTheirSlopes)

# Forces along a joint do not load its parent where that moves.
livens_mutant(NAME forces_along_joints_spare_parents
              FILE spacetime/nodal/kernel/tree_forces.cpp
              OLD [[for (const ForceAlongTree& force : forces_) add_outer(force.on_parent, force.by_parent, J);]]
              NEW [[;]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.StiffLoadsAreSolvedWithTheirSlopes)

# Nodes side by side, of which the last few have what joints let bodies do from others.
livens_mutant(NAME last_nodes_move_like_others
              FILE spacetime/elements/lane_joints.h
              RECOMPILE spacetime/elements/lanes_sse2.cpp
              OLD [[A + W <= of.p ? A : of.p - W]]
              NEW [[A + W <= of.p ? A : 0]]
              TESTS_OF unit_spacetime
              MUST_FAIL JointMotion.KeepsRowsAtAllNodesAtOnce)

# Moments of what loads supply, about the wrong arm.
livens_mutant(NAME supplies_turn_the_other_way
              FILE dynamics/lanes/load_program.cpp
              OLD [[add(moment_, cross(x, f));]]
              NEW [[add(moment_, cross(f, x));]]
              TESTS_OF properties
              MUST_FAIL */EveryLoad.Passes/*)

# Joints that close loops take no forces in the tangent.
livens_mutant(NAME loops_are_open_in_the_tangent
              FILE spacetime/nodal/kernel/tree_joints.cpp
              OLD [[J[(i * p + lane) * m * p + r * p + lane] = of[r * d + i];]]
              NEW [[;]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.StiffLoadsAreSolvedWithTheirSlopes)

# Rows that follow functions of time, in lanes.
livens_mutant(NAME drives_stand_still_in_lanes
              FILE dynamics/lanes/row_forms.cpp
              OLD [[factor({times[static_cast<std::size_t>(l)]}).value]]
              NEW [[factor({times[0]}).value]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.AgreesWithNewtonOnRowsThatFollowFunctions)
livens_mutant(NAME functions_keep_their_gradients_in_lanes
              FILE dynamics/lanes/row_forms.cpp
              OLD [[after[i].gradient[static_cast<std::size_t>(k)];]]
              NEW [[after[0].gradient[static_cast<std::size_t>(k)];]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.AgreesWithNewtonOnRowsThatFollowFunctions)
# Links that a heavy mass draws are stiff.
livens_mutant(NAME forces_of_joints_have_no_slopes
              FILE spacetime/nodal/kernel/joint_slopes.cpp
              OLD [[if (tables_.bodies[b].dofs == 6) add_turning(b);]]
              NEW [[if (tables_.bodies[b].dofs == 7) add_turning(b);]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.LinksThatAHeavyMassDrawsNeedNoNewton)

# A key that an unknown one stands for is said to be lacking as well: two errors for one mistake.
livens_mutant(NAME meant_key_lacks
              FILE io/scenario/schema/unknown_key.cpp
              OLD [[if (!other.meant.empty()) meant_.push_back(other.meant);]]
              NEW [[if (other.meant.empty()) meant_.push_back(other.meant);]]
              TESTS_OF unit_io
              MUST_FAIL Mistakes.OfKeysAreAnsweredWithTheKeyOrTheTable)

# Extremes of the motion, and what is accelerated.
livens_mutant(NAME extremes_are_those_of_samples
              FILE diagnostics/extremes.cpp
              OLD [[if (!look.has_better()) return {{place.value, place.at}, 0};]]
              NEW [[return {{place.value, place.at}, 0};]]
              TESTS_OF unit_spacetime
              MUST_FAIL Extremes.AreThoseOfTheFormula)
# States between element ends that are left where polynomials have them, and multipliers of nodes there.
livens_mutant(NAME states_between_ends_stay_open
              FILE dynamics/instant/settled_instant.cpp
              OLD [[system_.close(solved_);]]
              NEW [[(void)0;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Accelerations.StandOnTheJointsBetweenElementEnds)
livens_mutant(NAME forces_between_ends_of_nodes
              FILE diagnostics/joint_samples.cpp
              OLD [[if (end < 0 && !motion.end_multipliers.empty() && !motion.accelerations.empty()) {]]
              NEW [[if (end < -1 && !motion.accelerations.empty()) {]]
              TESTS_OF reference
              MUST_FAIL Driven.ForcesBetweenElementEndsAreThoseOfTheFormula)
# Series of the page do not follow a steep law, and nobody is told.
livens_mutant(NAME series_are_not_divided
              FILE io/report/curves.cpp
              OLD [[if (n_halved == 0) return true;]]
              NEW [[if (n_halved < columns.size() * n) return true;]]
              TESTS_OF unit_io
              MUST_FAIL Report.SeriesFollowSteepLaws)
# A base that is stated at rest is moved by a leg that swings.
livens_mutant(NAME stated_velocities_not_kept
              FILE io/scenario/run/start.cpp
              OLD [[if (said.of_place || said.of_turn) stated.velocities.push_back(said);]]
              NEW [[(void)said;]]
              TESTS_OF unit_io
              MUST_FAIL StatedVelocities.AreKeptWhereARateMovesTheStart)
livens_mutant(NAME accelerations_forget_what_turns
              FILE diagnostics/accelerations.cpp
              OLD [[A[12 * b + i] + phase.instant.system().centripetal()[12 * b + i];]]
              NEW [[-A[12 * b + i] + phase.instant.system().centripetal()[12 * b + i];]]
              TESTS_OF unit_spacetime
              MUST_FAIL Accelerations.AreWhatForcesMake)

# Half of a slot is drawn.
livens_mutant(NAME slot_drawn_by_half
              FILE multibody/joints/slot.cpp
              OLD [[(curve.last - curve.first) * k / pieces]]
              NEW [[0.5 * (curve.last - curve.first) * k / pieces]]
              TESTS_OF unit_multibody
              MUST_FAIL Joint.SlotKeepsItsWholeCurveToBeDrawn)

# What is looked at alone stands from the reference point on; shapes stand about the centre of mass.
livens_mutant(NAME visuals_lose_their_axes
              FILE io/scenario/bodies/visuals.cpp
              OLD [[one.axes = read_orientation(visual);]]
              NEW [[one.axes = identity<3>();]]
              TESTS_OF unit_io
              MUST_FAIL Visual.StandsWhereItIsSaidWhateverTheMass)
livens_mutant(NAME visuals_forget_the_colour_of_their_body
              FILE io/scenario/bodies/visuals.cpp
              OLD [[one.color = outline.color;]]
              NEW [[one.color = {};]]
              TESTS_OF unit_io
              MUST_FAIL Visual.HasTheColourOfItsBodyUnlessItHasItsOwn)
livens_mutant(NAME pictures_are_not_kept
              FILE io/scenario/bodies/meshes.cpp
              OLD [[for (const auto& [path, mesh] : seen_) text +=]]
              NEW [[for (const auto& [path, mesh] : kept_seen_) text +=]]
              TESTS_OF unit_io
              MUST_FAIL Visual.OfAMeshNeedNotBeClosedAndIsKeptByTheRun)

# Rows of a moved node in the axes that it has now: a step off a solution does not make them smaller.
livens_mutant(NAME rows_are_not_carried
              FILE spacetime/nodal/elimination.cpp
              OLD [[if (!maps_.empty()) to_factorised(x_.data());]]
              NEW [[;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Lobatto/TangentOf.ShortStepsShrinkTheNextIncrement/*)

# One pull, and bases from before it: multipliers leave a part of themselves in the rows.
livens_mutant(NAME bases_from_before_the_pull
              FILE spacetime/nodal/system.cpp
              OLD [[if (!are_placed && !(correction_ < before / 2)) return false;]]
              NEW [[if (!are_placed) return true;]]
              TESTS_OF convergence
              MUST_FAIL LobattoEnds.EveryRateNearbyFindsTheMotion)

# What has no dimension of its own may be added to anything: 0.4 and 30 mm.
livens_mutant(NAME unlike_quantities_are_added
              FILE io/scenario/text/amount.cpp
              OLD [[if (a.is_zero || b.is_zero) {]]
              NEW [[if (!a.has_unit || !b.has_unit) {]]
              TESTS_OF unit_io
              MUST_FAIL Computed.DimensionsThatDoNotGoTogetherAreBothSaid)

# Angles that are dropped everywhere: 3 Hz for 3 rad/s.
livens_mutant(NAME hertz_for_angular_velocity
              FILE io/scenario/text/amount.cpp
              OLD [[(has_no_angle && !amount.has_hertz)]]
              NEW [[has_no_angle]]
              TESTS_OF unit_io
              MUST_FAIL Computed.AnglesKeepTheirFactorAndAreNumbersOtherwise)

# The quotient of two lengths for a length.
livens_mutant(NAME ratio_for_length
              FILE io/scenario/text/amount.cpp
              OLD [[if (!amount.has_unit && amount.is_pure()]]
              NEW [[if (amount.is_pure()]]
              TESTS_OF unit_io
              MUST_FAIL Computed.DimensionsThatDoNotGoTogetherAreBothSaid)

# The shortest unit instead of the longest: "2 N/m" as 2 N over the parameter m.
livens_mutant(NAME shortest_unit
              FILE io/scenario/text/computed.cpp
              OLD [[for (auto end = ends.rbegin(); end != ends.rend(); ++end) {]]
              NEW [[for (auto end = ends.begin(); end != ends.end(); ++end) {]]
              TESTS_OF unit_io
              MUST_FAIL Computed.ParametersAreNumbersWithDimension)

# A run whose text has the file's own values: made again, it is another one.
livens_mutant(NAME set_values_not_kept
              FILE io/scenario/scenario.cpp
              OLD [[scenario.text = with_set_values(std::move(scenario.text), assembly.top().parameters());]]
              NEW [[;]]
              TESTS_OF unit_io
              MUST_FAIL ParametersOfScenarios.ThatAreSetStandInTheTextThatIsKept)

# Plain numbers that are set without the unit that the parameter has.
livens_mutant(NAME set_without_unit
              FILE io/scenario/text/set_values.cpp
              OLD [[if (one.is_in_unit_of_file &&]]
              NEW [[if (false && one.is_in_unit_of_file &&]]
              TESTS_OF unit_io
              MUST_FAIL ParametersOfScenarios.ThatAreSetStandInTheTextThatIsKept)

# -1^2 for (-1)^2.
livens_mutant(NAME index_without_parentheses
              FILE io/scenario/schema/repeat.cpp
              OLD [[return is_in_words || index_.value >= 0 ? digits : "(" + digits + ")";]]
              NEW [[return digits;]]
              TESTS_OF unit_io
              MUST_FAIL Repeat.CountsFromAnyFirstIndexUnderAnyName)

# What turns with a model that is added stays behind by a sign.
livens_mutant(NAME added_rows_shifted_back
              FILE multibody/relocation.cpp
              OLD [[moved.b_j = turned_j - outer(]]
              NEW [[moved.b_j = turned_j + outer(]]
              TESTS_OF properties
              MUST_FAIL Relocated.JointsHoldWhatTheyHeld)

# Velocities of what was added are seen as they are in the world.
livens_mutant(NAME added_loads_see_world_velocities
              FILE multibody/relocation.cpp
              OLD [[seen.V[k] = back_.rotation * at.V[k];]]
              NEW [[seen.V[k] = at.V[k];]]
              TESTS_OF properties
              MUST_FAIL Relocated/EveryMovedLoad.RunsInLanesAndPullsWhatItPulled/drag_drag)

# The same on a tape: places are turned back and not moved back.
livens_mutant(NAME added_arms_not_moved_back
              FILE multibody/loads/load_tape.cpp
              OLD [[v = v - vector(shift * load_.frame.position);]]
              NEW [[(void)shift;]]
              TESTS_OF properties
              MUST_FAIL Relocated/EveryMovedLoad.RunsInLanesAndPullsWhatItPulled/attraction_*)

# Drives and loads of an included file begin where it was stated, and not where the start has led it.
livens_mutant(NAME included_files_do_not_settle
              FILE io/scenario/assembly.cpp
              OLD [[if (builder_.model().version() != stated) settle();]]
              NEW [[;]]
              TESTS_OF unit_io
              MUST_FAIL Include.PartsBeginWhereTheStartHasLedThem)

# A file outside of the folder is found by a way that climbs.
livens_mutant(NAME includes_climb
              FILE io/scenario/bodies/meshes.cpp
              OLD [[        if (part == "..")]]
              NEW [[        if (part == "...")]]
              TESTS_OF unit_io
              MUST_FAIL Include.WhatCannotBeIncludedIsOneErrorAtTheKey)

# A point is taken for one of the body that the section names, whichever it is on.
livens_mutant(NAME points_of_other_bodies
              FILE io/scenario/bodies/named_points.cpp
              OLD [[if (builder.body_name(point.body) == body) return true;]]
              NEW [[return true;]]
              TESTS_OF unit_io
              MUST_FAIL NamedPoints.OneMistakeIsOneError)

# Velocities that are stated are moved without having been asked for.
livens_mutant(NAME stated_velocities_are_moved
              FILE io/scenario/scenario.cpp
              OLD [[if (fits && !assembly.states_velocity()) start_as_driven]]
              NEW [[if (fits) start_as_driven]]
              TESTS_OF unit_io
              MUST_FAIL DrivenStart.IsRefusedBesideVelocitiesThatDoNotFit)

# Drives that contradict are told of by the first element alone.
livens_mutant(NAME drives_that_contradict
              FILE dynamics/start/consistent_start.cpp
              OLD [[if (left.relative > start_tolerance) {]]
              NEW [[if (false && left.relative > start_tolerance) {]]
              TESTS_OF unit_io
              MUST_FAIL DrivenStart.HasNoVelocitiesForDrivesThatContradict)

# Reactions in the axes of a body, turned the other way.
livens_mutant(NAME reactions_turned_back
              FILE diagnostics/quantities.cpp
              OLD [[return transpose(project_directors(directors(X))) * v;]]
              NEW [[return project_directors(directors(X)) * v;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Quantities.OfPointsAndInAxesOfBodiesAreThoseOfTheWorldTurned)

# What series of a page lose between their instants is told as nothing.
livens_mutant(NAME lossless_series
              FILE io/report/curves.cpp
              OLD [[off = std::abs(shown - truth[c]);]]
              NEW [[off = 0 * std::abs(shown - truth[c]);]]
              TESTS_OF unit_io
              MUST_FAIL Report.SeriesSayWhatTheyLose)

# Centripetal parts of X'' left out of what velocities do to rows: right at rest.
livens_mutant(NAME state_drift
              FILE dynamics/coordinates/generalised_state.cpp
              OLD [[curvature += dot(gradient.by]]
              NEW [[curvature += 0 * dot(gradient.by]]
              TESTS_OF unit_dynamics
              MUST_FAIL GeneralisedState.AcceleratesBodiesAsTheEngineDoes
                        GeneralisedState.JacobianAndDriftAreThoseOfAPointThatMoves)

# Slopes of accelerations without those of loads: right where nothing springs.
livens_mutant(NAME state_slopes_of_loads
              FILE dynamics/coordinates/slopes.cpp
              OLD [[forces[i] = of_loads[i] - forces[i];]]
              NEW [[forces[i] = 0 * of_loads[i] - forces[i];]]
              TESTS_OF unit_dynamics
              MUST_FAIL GeneralisedState.SlopesAreThoseOfTheAccelerations)

# A dead centre taken for a loop that does not close.
livens_mutant(NAME state_dead_centre
              FILE dynamics/coordinates/lead.cpp
              OLD [[if (open <= turning && mechanism]]
              NEW [[if (false && open <= turning && mechanism]]
              TESTS_OF unit_dynamics
              MUST_FAIL GeneralisedState.NamesADeadCentre)

# The slope of a coupled displacement without its factor: right where the factor is one, as in racks and screws.
livens_mutant(NAME coupled_slide_slope
              FILE multibody/coupling_rows.cpp
              OLD [[value.gradient[0] = factor;]]
              NEW [[value.gradient[0] = factor / std::abs(factor);]]
              TESTS_OF properties
              MUST_FAIL CoupledJoints.ARowOfManyTermsIsTheSumOfThem)

# In lanes every function but the first reads the form behind its own: right for rows of one function, and for
# screws, whose angle comes first, but for what follows.
livens_mutant(NAME coupled_forms_of_lanes
              FILE dynamics/lanes/row_forms.cpp
              OLD [[            first += static_cast<int>(F.n);]]
              NEW [[            first += 1;]]
              TESTS_OF reference
              MUST_FAIL Couplings.RandomTreesOnALineMoveAsTheirReducedMasses)

# While a start is projected, a coupling takes the nearest of its equal positions and not the stated one.
livens_mutant(NAME coupling_lost_in_projection
              FILE dynamics/rows/rows.cpp
              OLD [[std::round((followed - values[r]) / row.period)]]
              NEW [[std::round(0 * (followed - values[r]) / row.period)]]
              TESTS_OF reference
              MUST_FAIL Couplings.AProjectedStartKeepsWhatTheStatedOneHad)

# A span that is drawn through a point grows again behind it.
livens_mutant(NAME rope_through_a_point
              FILE multibody/joints/rod.cpp
              OLD [[constexpr double closest = 0.01;]]
              NEW [[constexpr double closest = -1;]]
              TESTS_OF properties
              MUST_FAIL CoupledJoints.ASpanDoesNotPassThroughAPoint)

# An elastic rope pulls the ends of its first span alone: right for two points.
livens_mutant(NAME rope_of_one_span
              FILE multibody/loads/rope_spring.cpp
              OLD [[tape.pull(spans[k].b.side, spans[k].b.p, -s, r[k]);]]
              NEW [[tape.pull(spans[0].b.side, spans[0].b.p, -s, r[0]);]]
              TESTS_OF reference
              MUST_FAIL Ropes.RandomOnesMoveAsParticlesDo)

# A law rises with each turn, but not in the count of positions that are one.
livens_mutant(NAME law_without_its_rise
              FILE multibody/coupling_rows.cpp
              OLD [[value.value += rounds * law.rise;]]
              NEW [[value.value += 0 * rounds * law.rise;]]
              TESTS_OF reference
              MUST_FAIL Cams.ALawOfAnAngleMayRiseWithEachTurn)

# The second derivative of a law without that of the angle: the motion is right, and takes longer; accelerations are not.
livens_mutant(NAME law_without_bend
              FILE multibody/coupling_rows.cpp
              OLD [[-f.second * angle.gradient[k] * angle.gradient[l] - f.first * angle.hessian[k][l];]]
              NEW [[-f.second * angle.gradient[k] * angle.gradient[l];]]
              TESTS_OF properties
              MUST_FAIL CoupledJoints.ARopeAndACamPassTheKit)

# Points of rotors with weight: right where all rotors are across gravity.
livens_mutant(NAME rotors_with_weight
              FILE multibody/model.cpp
              OLD [[return !body.is_matter() ? Matrix34{} : outer(gravity, body.mass.column(0));]]
              NEW [[return body.holds_states() ? Matrix34{} : outer(gravity, body.mass.column(0));]]
              TESTS_OF unit_io
              MUST_FAIL RotorInertia.OfASlideIsMassWithoutWeight)

# The lever of a rotor without its root: right for the largest of those that share a point.
livens_mutant(NAME rotor_lever
              FILE multibody/rotors.cpp
              OLD [[std::sqrt(group[k].inertia / mass)]]
              NEW [[std::sqrt(group[0].inertia / mass)]]
              TESTS_OF unit_io
              MUST_FAIL RotorInertia.OfALoopMovesItAsBodiesBoundByRacksDo)

# What the world does to rotors left out of the supplied momentum: right for rotors between bodies.
livens_mutant(NAME rotors_without_support
              FILE diagnostics/balance.cpp
              OLD [[if (!rotors_.all.empty()) rotors_.now =]]
              NEW [[if (rotors_.all.empty()) rotors_.now =]]
              TESTS_OF unit_io
              MUST_FAIL RotorInertia.KeepsEnergyAndBalances)

# q'' without what velocities do to the coordinate: right at rest.
livens_mutant(NAME rotor_curvature
              FILE dynamics/coordinates/generalised_state.cpp
              OLD [[constraint_curvature(row, {mechanism->placed.t}, placed.X, state.V));]]
              NEW [[0 * constraint_curvature(row, {mechanism->placed.t}, placed.X, state.V));]]
              TESTS_OF unit_io
              MUST_FAIL RotorInertia.IsOneDiagonalTermOfTheMassMatrix)

# Growth of entries from merger to merger is not watched: right wherever exchanges do.
livens_mutant(NAME chain_without_reflections
              FILE solvers/chain.cpp
              OLD [[if (is_done && growth <= most_growth)]]
              NEW [[if (is_done)]]
              TESTS_OF unit_solvers
              MUST_FAIL ChainSolver.TurnsToReflectionsWhereExchangesLetEntriesGrow)

# The border of what is left of the elements before is dropped: right for a chain of one element.
livens_mutant(NAME chain_forgets_the_border
              FILE solvers/chain.cpp
              OLD [[std::copy_n(from + c + n, b, others + c + far);]]
              NEW [[std::copy_n(from + c + n, 0, others + c + far);]]
              TESTS_OF unit_solvers
              MUST_FAIL ChainSolver.AgreesWithTheWholeMatrixForAllSizesAndBorders)

# Where places are given two solutions agree, which is taken for a motion without an error.
livens_mutant(NAME given_places_have_no_error
              FILE diagnostics/estimate.cpp
              OLD [[is_given ? motion_.mesh.length(std::max(end - 1, 0)) : 0]]
              NEW [[is_given ? 0 * motion_.mesh.length(std::max(end - 1, 0)) : 0]]
              TESTS_OF convergence
              MUST_FAIL LobattoEnds.ErrorsOfOneElementAreToldWherePlacesAreGiven)

# What rounding may move is not compared: motions that the conditions leave free are told as known.
livens_mutant(NAME free_motions_are_taken
              FILE spacetime/solve_mesh.cpp
              OLD [[if (found.size <= undetermined) return found;]]
              NEW [[if (found.size <= 1e300) return found;]]
              TESTS_OF convergence
              MUST_FAIL LobattoEnds.ConjugateTimesOfAPendulumAreSingular)

# Elements of equal length again and again: as many as it takes where the motion is fastest.
livens_mutant(NAME elements_between_ends_are_even
              FILE spacetime/accuracy/remeshing.cpp
              OLD [[lengths[e] = std::clamp(share * scales_[e], most_shrunk * known, most_stretched * known);]]
              NEW [[lengths[e] = std::clamp(share * *std::ranges::min_element(scales_), most_shrunk * known, most_stretched * known);]]
              TESTS_OF convergence
              MUST_FAIL AccuracyBetweenEnds.PutsElementsWhereTheyAreNeeded)

# Two solutions that agree by chance are believed to any digit.
livens_mutant(NAME rounding_between_ends_is_forgotten
              FILE spacetime/accuracy/between_ends.cpp
              OLD [[return rounding_share * std::max(solution.report.moved_by_rounding, of_numbers(solution).rounding);]]
              NEW [[return 0 * std::max(solution.report.moved_by_rounding, of_numbers(solution).rounding);]]
              TESTS_OF convergence
              MUST_FAIL AccuracyBetweenEnds.IsGivenUpWhereRoundingIsMore)

# Element ends beside the bends of a law are taken for them: both solutions have the same error.
livens_mutant(NAME bends_between_ends_are_believed
              FILE spacetime/accuracy/between_ends.cpp
              OLD [[const bool is_good = has_stops_ && !is_off && error <= span().accuracy;]]
              NEW [[const bool is_good = has_stops_ && error <= span().accuracy;]]
              TESTS_OF convergence
              MUST_FAIL AccuracyBetweenEnds.EndsElementsWhereLawsBend)

# Moments of momentum are left out of what is known at an end.
livens_mutant(NAME given_moments_are_forgotten
              FILE spacetime/march/given_momenta.cpp
              OLD [[sum += dot(cross(X[b].column(a), P.column(a)), rates[b]);]]
              NEW [[sum += dot(cross(X[b].column(a), P.column(a)), 0 * rates[b]);]]
              TESTS_OF convergence
              MUST_FAIL MomentaBesideComponents.GiveTheMotionThatHasThem)

# The second solution is taken to have the numbers of the first.
livens_mutant(NAME numbers_have_no_error
              FILE spacetime/accuracy/estimate.cpp
              OLD [[std::max({std::abs(numbers_[i] - first.values[i]), rounding, left})]]
              NEW [[std::max({0 * std::abs(numbers_[i] - first.values[i]), rounding, left})]]
              TESTS_OF unit_io
              MUST_FAIL UnknownsToAccuracy.ErrorsAreToldOfGivenElements)

# A number at its bound is taken to be as exact as it comes out again and again.
livens_mutant(NAME bounds_have_no_error
              FILE spacetime/accuracy/estimate.cpp
              OLD [[left = i < first.left.size() ? first.left[i] : 0;]]
              NEW [[left = i < first.left.size() ? 0 * first.left[i] : 0;]]
              TESTS_OF unit_io
              MUST_FAIL UnknownsToAccuracy.BoundsThatAllButSufficeAreAsFarOffAsIsTold)

# An accuracy is one of the motion alone, however little it says of a number.
livens_mutant(NAME numbers_are_not_asked
              FILE spacetime/accuracy/between_ends.cpp
              OLD [[std::isnan(error) ? infinite : std::max(error, of_numbers(solution).largest)]]
              NEW [[std::isnan(error) ? infinite : std::max(error, 0 * of_numbers(solution).largest)]]
              TESTS_OF unit_io
              MUST_FAIL UnknownsToAccuracy.NumbersThatHardlyShowTakeShorterElements)

# Element ends at output times go with a duration that is found.
livens_mutant(NAME output_times_are_moved
              FILE spacetime/found.cpp
              OLD [[if (t > span.start && t < span.end && std::ranges::none_of(found, is_near)) held.push_back(t);]]
              NEW [[if (t > span.end && std::ranges::none_of(found, is_near)) held.push_back(t);]]
              TESTS_OF unit_io
              MUST_FAIL UnknownsToAccuracy.OutputTimesAreElementEnds)

# What comes out as zero is compared with itself.
livens_mutant(NAME found_zeros_have_no_size
              FILE spacetime/found.cpp
              OLD [[one.scale = scale_of(one);]]
              NEW [[one.scale = 0 * scale_of(one);]]
              TESTS_OF unit_io
              MUST_FAIL UnknownsToAccuracy.MayComeOutAsZero)

# The momentum at the end of time enters the balances as that at the start does.
livens_mutant(NAME border_sign
              FILE spacetime/nodal/elimination.cpp
              OLD [[last_row[i * m + f_ + i] = -1;]]
              NEW [[last_row[i * m + f_ + i] = 1;]]
              TESTS_OF unit_spacetime
              MUST_FAIL ComponentEquations.HaveAnExactTangent)

# Conditions are differentiated as if no momentum were there: Newton's iteration crawls.
livens_mutant(NAME conditions_at_rest
              FILE spacetime/march/end_point.cpp
              OLD [[moved.place_moved(*this, y.data(), momenta_)]]
              NEW [[moved.place_moved(*this, y.data(), std::vector<double>(momenta_.size()))]]
              TESTS_OF unit_spacetime
              MUST_FAIL ComponentEquations.HaveAnExactTangent)

# Two conditions that say one thing are taken for two.
livens_mutant(NAME conditions_said_twice
              FILE spacetime/march/components.cpp
              OLD [[if (!is_dependent(rows[i])) continue;
            const Condition& one]]
              NEW [[if (true) continue;
            const Condition& one]]
              TESTS_OF convergence
              MUST_FAIL Components.ThatDoNotDetermineAMotionAreRefusedByName)

# What was stated by component is not compared with what was found.
livens_mutant(NAME components_unmet
              FILE spacetime/march/component_values.cpp
              OLD [[if (std::abs(values[i] - one.value) <= met_component * scale) continue;]]
              NEW [[if (std::abs(values[i] - one.value) <= 1e30 * scale) continue;]]
              TESTS_OF convergence
              MUST_FAIL Components.ThatAreNotMetAreSuspect)

# Rows of light bodies are asked for more digits than the sums over a heavy one have.
livens_mutant(NAME sums_do_not_round
              FILE spacetime/nodal/kernel/march_kernel.cpp
              OLD [[rounding_of_rows * sums]]
              NEW [[0 * sums]]
              TESTS_OF convergence
              MUST_FAIL Accuracy.MassesOfAnyRatioEndWhereTheirSumsRound)

# The place of a heavy body is rounded by what the rods that hold it turn.
livens_mutant(NAME masses_round_places
              FILE spacetime/accuracy/perturbations.cpp
              OLD [[if (!are_roundings) return]]
              NEW [[if (are_roundings || !are_roundings) return]]
              TESTS_OF unit_spacetime
              MUST_FAIL Perturbations.RoundingOfAHeavyBodyDoesNotBendWhatHoldsIt)

# Steps that have met rounding speak against the factor.
livens_mutant(NAME rounding_forgets_a_factor
              FILE spacetime/nodal/kernel/march_kernel.cpp
              OLD [[!progress.is_done && progress.contraction]]
              NEW [[progress.contraction]]
              TESTS_OF unit_spacetime
              MUST_FAIL MarchKernel.AFactorServesElementsOfTheSameLength)

# Of many marches nobody asks which is the nearest.
livens_mutant(NAME any_march_is_the_nearest
              FILE spacetime/guess.cpp
              OLD [[all[i] = {factor, missing(model, march_with(factor), far, given)};]]
              NEW [[all[i] = {factor, 1.0};]]
              TESTS_OF unit_spacetime
              MUST_FAIL Guess.FromManySizesOfRatesArrivesNearest)

# A curve goes back where its way does.
livens_mutant(NAME curves_end_at_folds
              FILE spacetime/curve.cpp
              OLD [[with_last < 0 ? -norm : norm]]
              NEW [[norm]]
              TESTS_OF unit_spacetime
              MUST_FAIL Curve.PassesFoldsWhereTheWayTurnsBack)

# What an iteration that failed came to is thrown away, so that nothing can be looked at.
livens_mutant(NAME iterates_are_thrown_away
              FILE spacetime/solve_mesh.cpp
              OLD [[w.keeps_iterate = is_nodal(method);]]
              NEW [[w.keeps_iterate = false;]]
              TESTS_OF convergence
              MUST_FAIL LobattoEnds.ThatAreNotFoundLeaveTheLastIterate)

# The arrival is told by what places at the start move it by, not rates.
livens_mutant(NAME arrival_by_places
              FILE spacetime/nodal/arrival.cpp
              OLD [[conditions[static_cast<std::size_t>(f + j)] = 1;]]
              NEW [[conditions[static_cast<std::size_t>(j)] = 1;]]
              TESTS_OF convergence
              MUST_FAIL Arrival.IsWhatMarchesFromChangedStartsSay)

# One motion is found twice.
livens_mutant(NAME one_root_twice
              FILE spacetime/roots.cpp
              OLD [[return off <= std::max(one_motion, 10 * errors);]]
              NEW [[return off < 0;]]
              TESTS_OF convergence
              MUST_FAIL Roots.AreDistinct)

# A motion that comes back once is taken for a periodic one.
livens_mutant(NAME one_period_is_enough
              FILE spacetime/accuracy/judging.cpp
              OLD [[if (second.report.converged() && off <= allowed) return "";]]
              NEW [[if (off < 1e30) return "";]]
              TESTS_OF convergence
              MUST_FAIL Periodic.AnotherPeriodOfWhatDrivesIsSuspect)

# Whatever moves is taken for driven.
livens_mutant(NAME all_is_driven
              FILE spacetime/march/conserved.cpp
              OLD [[if (F != first) return true;]]
              NEW [[return true;]]
              TESTS_OF convergence
              MUST_FAIL Periodic.MotionsOfWhatNothingDrivesAreRefusedWithoutMore)

# The end of a motion is compared as it stands, not turned back.
livens_mutant(NAME turns_are_not_taken_back
              FILE multibody/state_quantities.cpp
              OLD [[const AxisTurn back = quantity.before->back();]]
              NEW [[const AxisTurn back{0};]]
              TESTS_OF unit_io
              MUST_FAIL FreePeriodic.SphericalPendulumsComeBackTurned)

# What a load takes away is taken for kept.
livens_mutant(NAME all_is_conserved
              FILE spacetime/march/conserved.cpp
              OLD [[if (!std::ranges::all_of(places, is_kept)) continue;]]
              NEW [[if (places.empty()) continue;]]
              TESTS_OF unit_io
              MUST_FAIL FreePeriodic.LimitCyclesNeedOneConditionAlone)

# A kept quantity that follows from others asks for a condition.
livens_mutant(NAME dependent_quantities_are_kept
              FILE spacetime/march/conserved.cpp
              OLD [[if (!std::ranges::any_of(places, is_new)) kept.pop_back();]]
              NEW [[if (places.empty()) kept.pop_back();]]
              TESTS_OF unit_io
              MUST_FAIL FreePeriodic.PendulumsHaveTheirPeriods)

# The turn need not be a symmetry.
livens_mutant(NAME any_turn_is_a_symmetry
              FILE spacetime/march/conserved.cpp
              OLD [[if (!(off <= unchanged * size) || !(bent <= unchanged * most)) return false;]]
              NEW [[if (!(off <= unchanged * size)) return false;]]
              TESTS_OF unit_io
              MUST_FAIL FreePeriodic.WhatDoesNotDetermineThemIsRefused)

# A motion is unfolded by a direction that its other conditions reach as well.
livens_mutant(NAME unfolded_along_what_is_known
              FILE spacetime/march/numbered.cpp
              OLD [[one.value += unfolded[c] * ends_.periodic.unfolding[c][i - n];]]
              NEW [[one.value += 0 * unfolded[c] * ends_.periodic.unfolding[c][i - n];]]
              TESTS_OF unit_io
              MUST_FAIL FreePeriodic.PendulumsHaveTheirPeriods)

# Bodies at rest count as a periodic motion.
livens_mutant(NAME rest_is_periodic
              FILE spacetime/other_motions.cpp
              OLD [[if (!ends.periodic.is_free) return false;]]
              NEW [[if (ends.periodic.is_free || !ends.periodic.is_free) return false;]]
              TESTS_OF unit_io
              MUST_FAIL FreePeriodic.BodiesAtRestAreNone)

# Turns are conditions of periodic motions.
livens_mutant(NAME periods_count_turns
              FILE spacetime/march/end_conditions.cpp
              OLD [[if (condition.forgets_turns && q.counts_turns())]]
              NEW [[if (false)]]
              TESTS_OF convergence
              MUST_FAIL Periodic.MotionsMayTurnRound)

# Of all places that are given at an end those are forgotten that no condition stands for.
livens_mutant(NAME places_beside_are_not_compared
              FILE spacetime/accuracy/met_ends.cpp
              OLD [[return ends.has_components() ? whole : at;]]
              NEW [[return ends.has_components() ? Known::nothing : at;]]
              TESTS_OF convergence
              MUST_FAIL Components.StandBesidePlacesOfAllBodies)

# The energy of a body has the sign of its weight wrong.
livens_mutant(NAME energy_of_weight
              FILE multibody/state_quantities.cpp
              OLD [[kinetic_of(body, V[at]) - dot(weight, X[at])]]
              NEW [[kinetic_of(body, V[at]) + dot(weight, X[at])]]
              TESTS_OF convergence
              MUST_FAIL Components.AreSpeedsAndEnergies)

# What joints before an event take off momenta there is forgotten behind it.
livens_mutant(NAME momenta_over_events_do_not_turn
              FILE spacetime/nodal/phases_condensed.cpp
              OLD [[momenta[i] += weight / h *]]
              NEW [[momenta[i] += 0 * weight / h *]]
              TESTS_OF unit_spacetime
              MUST_FAIL PhaseEquations.HaveAnExactTangent)

# Switches of joints stay where they are guessed.
livens_mutant(NAME elements_do_not_follow_releases
              FILE spacetime/march/numbered.cpp
              OLD [[t = moved_with(anchors_.instants, t, anchors.instants)]]
              NEW [[t = anchors_.events.empty() ? moved_with(anchors_.instants, t, anchors.instants) : t]]
              TESTS_OF convergence
              MUST_FAIL Releases.InstantThatHitsATargetIsFound)

# Joints that begin where bodies are elsewhere are taken for what holds them.
livens_mutant(NAME impacts_between_ends
              FILE spacetime/solve_mesh.cpp
              OLD [[if (!is_met(]]
              NEW [[if (false && !is_met(]]
              TESTS_OF convergence
              MUST_FAIL PhasesBetweenEnds.AJointThatBeginsMustFindItsBodies)

# The axis of a second angle stays where it is: the world supplies what its rotor does not have.
livens_mutant(NAME rotor_axes_stand
              FILE multibody/rotors.cpp
              OLD [[momentum * (mixed + coordinate_rate(]]
              NEW [[0 * momentum * (mixed + coordinate_rate(]]
              TESTS_OF unit_io
              MUST_FAIL RotorInertia.OfUniversalAndBallJointsIsThatOfTheirHinges)

# Loads act along rotation vectors beyond where these begin again, and nobody looks.
livens_mutant(NAME rotation_vectors_without_end
              FILE spacetime/accuracy/load_limits.cpp
              OLD [[for (const JointCoordinate& q : load.rotations) add(]]
              NEW [[for (const JointCoordinate& q : std::vector<JointCoordinate>()) add(]]
              TESTS_OF unit_io
              MUST_FAIL RotationVector.BeyondWhereItEndsIsRefusedOrTold)

# Elements of the paper: momenta at the start push into the law with the sign of those at the end.
livens_mutant(NAME momenta_of_a_border_all_leave
              FILE spacetime/mixed/border.cpp
              OLD [[at_end ? P.a[c] : -P.a[c])]]
              NEW [[at_end ? P.a[c] : P.a[c])]]
              TESTS_OF unit_io
              MUST_FAIL MixedComponents.ConvergeToTheMotionThatTheConditionsHave)

# Nobody asks elements of the paper whether conditions determine the motion.
livens_mutant(NAME mixed_motions_left_free
              FILE spacetime/solve_mesh.cpp
              OLD [[if (is_asked && is_mixed && report.converged())]]
              NEW [[if (false && is_asked && is_mixed && report.converged())]]
              TESTS_OF unit_io
              MUST_FAIL MixedComponents.WhatLeavesAMotionFreeIsRefused)

# An exchange of rows that goes beyond a reflection is left out with it.
livens_mutant(NAME exchanges_left_out
              FILE solvers/orthogonal_basis.cpp
              OLD [[reflections_[j].reach = std::max(end, reflections_[j].lead + 1);]]
              NEW [[reflections_[j].reach = end;]]
              TESTS_OF unit_solvers
              MUST_FAIL OrthogonalBasis.LeavesOutNothingButZeros)

# Blocks of (B, A) have the columns of the next freedom: right for one.
livens_mutant(NAME columns_of_the_next_freedom
              FILE spacetime/nodal/mass_products.cpp
              OLD [[double* __restrict number = to.at + i;]]
              NEW [[double* __restrict number = to.at + (i + 1) % f_;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Lobatto/TangentOf.IsThatOfTheBlocksThatAreSolved/2)

# Products of mass of a body with skew axes as if these were its own.
livens_mutant(NAME skew_mass_as_straight
              FILE spacetime/nodal/mass_products.cpp
              OLD [[if (body.principal)]]
              NEW [[if (f > 0)]]
              TESTS_OF unit_spacetime
              MUST_FAIL MassProducts.AreThoseOfTheMassBetweenNodes)

# What joints make of two bodies passed on before the last row of the last joint.
livens_mutant(NAME last_crossing_forgotten
              FILE spacetime/nodal/tangent.cpp
              OLD [[    crossing.pass_on();]]
              NEW [[    ;]]
              TESTS_OF unit_spacetime
              MUST_FAIL Lobatto/TangentOf.MatchesDifferencesWithEveryKindOfTerm/1)

# Numbers behind the last full register forgotten.
livens_mutant(NAME rows_in_full_registers_alone
              FILE solvers/detail/rows_in_registers.h
              OLD [[for (; i < n; ++i) y[i] -= a * x[i];]]
              NEW [[;]]
              RECOMPILE solvers/rows_sse2.cpp
              TESTS_OF unit_solvers
              MUST_FAIL RowFunctions.AreSumsOverNumbers)

# Rows of U that are solved together taken for one of no triangle.
livens_mutant(NAME factors_without_their_triangles
              FILE solvers/detail/rows_in_registers.h
              OLD [[for (int l = k + 1; l < 4; ++l) sums[k] += d[k * n + l] * x[i + l];]]
              NEW [[;]]
              RECOMPILE solvers/rows_sse2.cpp
              TESTS_OF unit_solvers
              MUST_FAIL DenseLU.SolvesRandomSystemsOfEverySizeToRounding)

# Conditions alone asked in the rows of the last balances.
livens_mutant(NAME conditions_before_their_rows
              FILE solvers/chain_solution.cpp
              OLD [[work_.front.insert(work_.front.end(), rows.begin(), rows.end());]]
              NEW [[work_.front.insert(work_.front.begin(), rows.begin(), rows.end());]]
              TESTS_OF unit_solvers
              MUST_FAIL ChainSolver.ConditionsAloneGiveTheEnds)

# Rates that joints do not have are projected by masses, which then seem to be seen.
livens_mutant(NAME masses_seen_by_projection
              FILE spacetime/unseen_number.cpp
              OLD [[return tried.closed ? tried.closed->start : state;]]
              NEW [[return state;]]
              TESTS_OF unit_io
              MUST_FAIL UnknownsOfFiles.ThatNothingShowsAreToldWhereTheyStand)

# Pivots as they come, not the largest of their columns.
livens_mutant(NAME stretches_without_pivoting
              FILE solvers/stretch.cpp
              OLD [[if (!(size <= largest) && !std::isnan(largest)) largest = size, pivot = place;]]
              NEW [[if (pivot < 0) largest = size, pivot = place;]]
              TESTS_OF unit_solvers
              MUST_FAIL Staircase.TakesTheLargestPivot)

# What eliminations put into the rows of others is not looked at.
livens_mutant(NAME fill_in_of_stretches_forgotten
              FILE solvers/stretch.cpp
              OLD [[        take_bits(bits, words, place);]]
              NEW [[        ;]]
              TESTS_OF unit_solvers
              MUST_FAIL Staircase.SolvesWhatTheGeneralSolverSolves)

# An element at the border of two threads' functions is left to the one before.
livens_mutant(NAME elements_of_one_thread_alone
              FILE spacetime/mixed/functions.cpp
              OLD [[return {std::max(low - p, 0), std::min(last + p, n_elements())};]]
              NEW [[return {begin > 0 ? low + 1 : 0, std::min(last + p, n_elements())};]]
              TESTS_OF unit_spacetime
              MUST_FAIL Threads.LeaveNoTraceInTheBitsOfMotions)

# Violations that add up along nodes are taken where threads find their changes.
livens_mutant(NAME violations_before_those_of_the_nodes_before
              FILE spacetime/nodal/node_violations.cpp
              OLD [[if (!Crew::divides(n, least_shared)) {]]
              NEW [[if (Crew::divides(n, least_shared)) return std::isfinite(sum); else {]]
              TESTS_OF unit_spacetime
              MUST_FAIL Threads.LeaveNoTraceInTheBitsOfMotions)

# Rows in lanes are not scaled by both of their sides.
livens_mutant(NAME rows_in_lanes_forget_a_side
              FILE dynamics/lanes/lane_rows.h
              RECOMPILE spacetime/elements/lanes_sse2.cpp
              OLD [[const Lanes<W> square = squares[0] + squares[1];]]
              NEW [[const Lanes<W> square = squares[0];]]
              TESTS_OF unit_spacetime
              MUST_FAIL RowsInLanes.AreThoseOfOneNode)

# What goes from item to item does not wait for the threads that have the items.
livens_mutant(NAME what_follows_does_not_wait
              FILE solvers/crew.cpp
              OLD [[if (!turns.await(i) || !then(i)) return turns.break_off();]]
              NEW [[if (!then(i)) return turns.break_off();]]
              TESTS_OF unit_solvers
              MUST_FAIL Crew/LoopsInOrder.WhatFollowsComesBehindItsWork*)

# What a solution leaves of the rows that two elements share is that of the later one alone.
livens_mutant(NAME residuals_of_one_element
              FILE solvers/chain_solution.cpp
              OLD [[if (e > 0) take_rows(e - 1, far_rows(e - 1), matrix_.n_rows(e - 1));]]
              NEW [[if (e < 0) take_rows(e, 0, 0);]]
              TESTS_OF unit_solvers
              MUST_FAIL All/LinearSolvers.EqualADenseSolution/*)

# Values behind elements that were left out are put where they would stand if time was shorter.
livens_mutant(NAME matrices_drawn_out_without_values
              FILE spacetime/mixed/matrix_pattern.cpp
              OLD [[before[element.n_cuts] + (element.copy > 0]]
              NEW [[(element.copy > 0]]
              TESTS_OF unit_spacetime
              MUST_FAIL AllPairings/MixedEquations.HaveTheMatrixOfTheirResidualWithManyElements/NaturalEqualX0P0)

# The instant of an event left where the polynomial's slope has it, which is of a lower order than the state.
livens_mutant(NAME event_by_the_polynomial
              FILE spacetime/phases/event_end.cpp
              OLD [[if (std::abs(zero - now) <= std::max(near_event * (end - start), of_clock * std::abs(now))) break;]]
              NEW [[if (std::abs(zero - now) <= 1e-2 * (end - start)) break;]]
              TESTS_OF unit_io
              MUST_FAIL DecidedEvents.HaveTheOrderOfStatesAlsoWhereRatesAreAskedFor)

# The second solution with the instants of the first one, without what their errors do.
livens_mutant(NAME event_without_an_error
              FILE spacetime/accuracy/reference_events.cpp
              OLD [[of_first[k]->error = std::max(std::abs(later) + of_first[k]->rounding, kept_error * before);]]
              NEW [[of_first[k]->error = 0;]]
              TESTS_OF unit_io
              MUST_FAIL DecidedEvents.HaveTheOrderOfStatesAlsoWhereRatesAreAskedFor)

# Phases that are followed by second solutions of their own from the first; and a whole that is taken although it is off.
livens_mutant(NAME phases_followed_at_once
              FILE spacetime/phases/phases.cpp
              OLD [[problem_.is_followed = accuracy_ < judged_as_whole;]]
              NEW [[problem_.is_followed = true;]]
              TESTS_OF unit_io
              MUST_FAIL DecidedEvents.HaveOneSecondSolutionWhereItIsEnough)
livens_mutant(NAME whole_taken_although_off
              FILE spacetime/phases/phases.cpp
              OLD [[whole.report.converged() && !found.empty() && found.largest <= accuracy_;]]
              NEW [[whole.report.converged();]]
              TESTS_OF unit_io
              MUST_FAIL DecidedEvents.HaveOneSecondSolutionWhereItIsEnough)

# A load with a condition that acts all the time in lanes.
livens_mutant(NAME load_beyond_its_event
              FILE multibody/events.cpp
              OLD [[inner->forces.record(tape, factor * tape.of_time(acts));]]
              NEW [[inner->forces.record(tape, factor);]]
              TESTS_OF unit_io
              MUST_FAIL DecidedEvents.EndLoadsAndTakeWhatActsTogether)

# Impacts without a bounce.
livens_mutant(NAME stops_without_restitution
              FILE dynamics/instant/impact.cpp
              OLD [[least[i] = stops[i].impact->restitution * std::max(-outcome.stops[i].approach, 0.0);]]
              NEW [[least[i] = 0;]]
              TESTS_OF unit_io
              MUST_FAIL Stops.OfFullRestitutionLoseNothing)

# Stops that hold whatever pulls.
livens_mutant(NAME stops_that_pull
              FILE multibody/joints/stops.cpp
              OLD [[out[0] = side * reactions[0];]]
              NEW [[out[0] = -std::abs(side * reactions[0]);]]
              TESTS_OF unit_io
              MUST_FAIL Stops.OpenWhereTheyWouldPull)

# Bounces followed for ever.
livens_mutant(NAME bounces_without_rest
              FILE spacetime/phases/contacts.cpp
              OLD [[one.closes = hop < lowest_hop * stop.rows[0].scale || rebound <= slow;]]
              NEW [[one.closes = hop < 0 || rebound <= slow;]]
              TESTS_OF unit_io
              MUST_FAIL Stops.BallComesToRestBehindBouncesWithoutEnd)

# What one rank hands on is not taken off by the other.
livens_mutant(NAME transfer_sign
              FILE spacetime/mixed/rank_block.cpp
              OLD [[+= sign * transfers_]]
              NEW [[+= std::abs(sign) * transfers_]]
              TESTS_OF unit_spacetime
              MUST_FAIL OnRanks.StatesAreThoseOfTheSerialRun)

# What is alike at both ends of time is not handed on from the first rank to the last one.
livens_mutant(NAME conditions_of_one_rank
              FILE spacetime/mixed/rank_block.cpp
              OLD [[own_.between[i], -1}]]
              NEW [[own_.between[i], 1}]]
              TESTS_OF unit_io
              MUST_FAIL RanksBorder.PeriodicMotionsAreThoseOfTheSerialRun)

# Every rank counts its turns from where the first one begins.
livens_mutant(NAME turns_of_each_rank
              FILE spacetime/mixed/border.cpp
              OLD [[if (e == 0 && s == 0 && !has(false)) begin = angle.now();]]
              NEW [[if (e == 0 && s == 0 && !has(false)) begin = from;]]
              TESTS_OF unit_io
              MUST_FAIL RanksBorder.ConditionsByComponentAreThoseOfTheSerialRun)

# Neighbours take free motions of one another for their own.
livens_mutant(NAME motions_of_neighbours
              FILE solvers/ranks/rank_ends.cpp
              OLD [[is_row ? to[j] += from[i] * value : to[i] += value * from[j];]]
              NEW [[is_row ? to[i] += value * from[j] : to[i] += value * from[j];]]
              TESTS_OF unit_solvers
              MUST_FAIL RankEnds.PartsOfAChainAreSolvedLikeTheWhole)

# A condition of both ends is not joined from the first rank to the last one.
livens_mutant(NAME ends_not_joined
              FILE spacetime/nodal/ranks_window.cpp
              OLD [[= last ? -1 : 1;]]
              NEW [[= 1;]]
              TESTS_OF unit_io
              MUST_FAIL RanksLobatto.PeriodicMotionsAreThoseOfTheSerialRun)

# Laws of every rank count turns from where the first one begins.
livens_mutant(NAME turns_not_relayed
              FILE spacetime/nodal/ranks_window.cpp
              OLD [[system().begin_angles(angles);]]
              NEW [[if (ranks_.is_first()) system().begin_angles(angles);]]
              TESTS_OF unit_io
              MUST_FAIL RanksLobatto.MotionsFromAStateAreThoseOfTheSerialRun)

# What elements of ranks did not see is believed.
livens_mutant(NAME unseen_on_ranks
              FILE spacetime/on_ranks.cpp
              OLD [[if (options.divide && ends.has_state()) w.criteria]]
              NEW [[if (!options.divide && ends.has_state()) w.criteria]]
              TESTS_OF unit_io
              MUST_FAIL RanksLobatto.ElementsThatDoNotSeeTheMotionAreRefused)

# States by the mass of what holds them.
livens_mutant(NAME states_with_mass
              FILE multibody/controllers.cpp
              OLD [[along_axis(body, k, scale.mass * unit_of(state, scale))]]
              NEW [[along_axis(body, k, unit_of(state, scale))]]
              TESTS_OF unit_io
              MUST_FAIL Controllers.HaveTheAccuracyThatIsAskedFor)

# Controllers that are not asked at the start.
livens_mutant(NAME first_sample_missed
              FILE spacetime/phases/samplings.cpp
              OLD [[if (k < 0 || std::abs(instant - state.t) > gap]]
              NEW [[if (k < 1 || std::abs(instant - state.t) > gap]]
              TESTS_OF unit_io
              MUST_FAIL Controllers.ThatAreSampledAreTheirRecursion)

# Reactions as if the loads that read them did nothing to them.
livens_mutant(NAME reactions_without_friction
              FILE dynamics/instant/reaction_mechanism.cpp
              OLD [[all[j].force += factors[k] * by_unit[k][j].force;]]
              NEW [[all[j].force += 0.0 * factors[k] * by_unit[k][j].force;]]
              TESTS_OF unit_io
              MUST_FAIL ReactionLaws.RubAsTheirEquationsSay)

# Poles of controllers without what positions do to states.
livens_mutant(NAME states_blind_to_positions
              FILE statics/vibration_modes.cpp
              OLD [[A(2 * n + k, i) = -z.by_q[]]
              NEW [[A(2 * n + k, i) = -0.0 * z.by_q[]]
              TESTS_OF unit_io
              MUST_FAIL Controllers.AreAtRestWithTheirBodies)

# Reactions that a part reads along the axes of the whole: right where it is not turned.
livens_mutant(NAME reactions_not_turned
              FILE multibody/relocation.cpp
              OLD [[reaction.along = to.by.rotation * reaction.along;]]
              NEW [[(void)0;]]
              TESTS_OF unit_io
              MUST_FAIL Include.LoadsReadReactionsOfTheirParts
                        ReactionLaws.MoveWithTheirModels)

# Laws that read the joint of the same number in a phase without some joints.
livens_mutant(NAME reactions_by_number
              FILE multibody/acting_model.cpp
              OLD [[one.joint = at == acting.joints.end() ? -1 : static_cast<int>(at - acting.joints.begin());]]
              NEW [[one.joint = std::min(one.joint, static_cast<int>(acting.joints.size()) - 1);]]
              TESTS_OF unit_io
              MUST_FAIL ReactionLaws.ReadStops)

# An impact that goes on through bodies that touch, by a law that nobody named.
livens_mutant(NAME impact_handed_on
              FILE spacetime/phases/contacts.cpp
              OLD [[is_handed_on = true;]]
              NEW [[is_handed_on = false;]]
              TESTS_OF unit_io
              MUST_FAIL Stops.AreMetThroughBodiesThatTouch)

# Phases share what acts although an event has changed that: a stop that closes holds nothing.
livens_mutant(NAME phases_as_before
              FILE spacetime/phases/phase_model.cpp
              OLD [[if (acting_by_ == decisions.changes() && joints == joints_ && !reads_reactions_) {]]
              NEW [[if (acting_by_ >= 0 && !reads_reactions_) {]]
              TESTS_OF unit_io
              MUST_FAIL Stops.WithoutRestitutionTheyCloseAtOnce)

# Where polynomials have kinks a top between them is not asked for by states.
livens_mutant(NAME tops_of_polynomials
              FILE spacetime/phases/near_misses.cpp
              OLD [[if (has_top || from > other.end()) continue;]]
              NEW [[continue;]]
              TESTS_OF unit_io
              MUST_FAIL ToldErrorsOfImpacts.GrazesThatKinksHideAreUndecided)

# What the polynomial says is about to come without the slack of stops: bodies side by side meet at each element.
livens_mutant(NAME come_by_rounding
              FILE spacetime/phases/event_watch.cpp
              OLD [[return slack(e) > 0 ? margin(e, state) > slack(e) : holds_at(e, state);]]
              NEW [[return holds_at(e, state);]]
              TESTS_OF unit_io
              MUST_FAIL Stops.AreMetThroughBodiesThatTouch)

# A body that was beyond its stop before the last element is taken to be there no sooner than at its end.
livens_mutant(NAME slack_is_no_event
              FILE spacetime/phases/event_end.cpp
              OLD [[                drop_last(motion);
                return end_at_event(phase, fired, solved);]]
              NEW [[                break;]]
              TESTS_OF unit_io
              MUST_FAIL ToldErrorsOfImpacts.NeighboursThatTouchWithoutEndAreGivenUp)

# Speeds of impacts by the row of a distance, which is of its square.
livens_mutant(NAME speed_of_squares
              FILE spacetime/phases/contacts.cpp
              OLD [[return norm(line);]]
              NEW [[return 1;]]
              TESTS_OF unit_io
              MUST_FAIL Stops.AreMetThroughBodiesThatTouch)

# The first stop that would have to pull keeps its impulse.
livens_mutant(NAME stop_that_pulls
              FILE dynamics/instant/impact.cpp
              OLD [[if ((*back)[k] > 0 &&]]
              NEW [[if (false &&]]
              TESTS_OF unit_dynamics
              MUST_FAIL Impact.LetsGoOfStopsThatWouldPull)

# Conditions that a jump makes true are left to become false first.
livens_mutant(NAME jumps_make_nothing_true
              FILE spacetime/phases/event_margins.cpp
              OLD [[if (!(before[e] <= least && now[e] > least)) continue;]]
              NEW [[if (now[e] >= least || now[e] < least) continue;]]
              TESTS_OF unit_io
              MUST_FAIL EventsByJumps.AreAtTheSampleThatMakesThemTrue)

# Samples that fall together but for rounding have a phase between them.
livens_mutant(NAME near_samples_stay_apart
              FILE spacetime/phases/events.cpp
              OLD [[*std::ranges::lower_bound(breaks, t - gap);]]
              NEW [[*std::ranges::lower_bound(breaks, t - 0 * gap);]]
              TESTS_OF unit_io
              MUST_FAIL Controllers.ThatAreSampledMayMeetWhatEnds)

# Short elements, which end where a condition becomes false, tell by themselves what comes behind them.
livens_mutant(NAME looks_by_short_elements
              FILE spacetime/phases/event_watch.cpp
              OLD [[const double way = behind * length;]]
              NEW [[const double way = behind * motion.mesh.length(std::max(end - 1, 0));]]
              TESTS_OF unit_io
              MUST_FAIL DirectionsOfEvents.ConditionsBecomeTrueWhereTheyRiseAlone)

# The slope of a short element's polynomial says that a condition rises.
livens_mutant(NAME rising_by_slope
              FILE spacetime/phases/event_watch.cpp
              OLD [[margin(e, look) > margin(e, end) && comes_at_once(so_far, e);]]
              NEW [[comes_at_once(so_far, e);]]
              TESTS_OF unit_io
              MUST_FAIL DirectionsOfEvents.ConditionsBecomeTrueWhereTheyRiseAlone)

# Bends of stated elements between both ends are looked for once, and where they are found is not asked again.
livens_mutant(NAME stated_bends_are_believed
              FILE spacetime/accuracy/settled_bends.cpp
              OLD [[if (moved <= settled || (moved]]
              NEW [[if (moved < 1 || (moved]]
              TESTS_OF reference
              MUST_FAIL Bends.BetweenBothEndsTheEstimateHolds)

# A jump beside a state is a slope of a law that reads reactions.
livens_mutant(NAME jumps_by_reactions_are_slopes
              FILE dynamics/instant/reaction_laws.cpp
              OLD [[return off > alike * shorter * most;]]
              NEW [[return false;]]
              TESTS_OF unit_io
              MUST_FAIL ReactionLaws.ThatJumpWhereTheMotionBeginsAreNoDampers)

# The second solution has the bends of the first, whose errors both have.
livens_mutant(NAME bends_of_the_first_alone
              FILE spacetime/accuracy/settled_bends.cpp
              OLD [[if (lobatto == nullptr) return first;]]
              NEW [[if (lobatto == nullptr || problem.near != nullptr) return first;]]
              TESTS_OF unit_io
              MUST_FAIL UnknownsOfFiles.AreFoundWhereForcesJump)

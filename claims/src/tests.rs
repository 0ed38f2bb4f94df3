use super::*;

pub(super) fn lab() -> Lab {
    let settings = LabSettings {
        size: [64, 48],
        repeat: 1,
        ..LabSettings::default()
    };
    Lab::new(settings, None)
}

#[test]
fn names_are_unique_and_say_their_paper() {
    let mut names: Vec<&str> = claims().map(|c| c.id).collect();
    assert!(names.len() >= 50);
    for name in &names {
        let safe = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(name.chars().all(safe), "{name}");
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), claims().count());
    assert!(
        find("paper2-culing")
            .unwrap_err()
            .to_string()
            .contains("paper2-culling")
    );
}

/// D is quoted, everything else is measured; every verdict occurs.
#[test]
fn what_is_quoted_is_not_measured() {
    for claim in claims() {
        assert_eq!(
            claim.measuring.is_none(),
            claim.verdict == Verdict::Quoted,
            "{}",
            claim.id
        );
        assert!(!claim.statement.is_empty() && !claim.source.is_empty());
    }
    let has = |letter: char| claims().any(|c| c.verdict.letter() == letter);
    assert!("ABCD".chars().all(has));
    let quoted = find("paper4-frame-rates").unwrap();
    assert_eq!(quoted.measure(&mut lab()).unwrap(), None);
}

#[test]
fn arithmetic_holds_at_any_size() {
    for id in [
        "paper3-texture-size",
        "paper4-table-memory",
        "paper1-one-division",
    ] {
        let found = find(id).unwrap().measure(&mut lab()).unwrap().unwrap();
        assert_eq!(
            found.judgement(),
            Judgement::Holds,
            "{id}: {:?}",
            found.measures
        );
    }
}

/// 127 overlaps fit, not 256: shown as what it is, and credited to the buffer.
#[test]
fn a_wrong_claim_does_not_hold() {
    let found = find("paper2-overlaps")
        .unwrap()
        .measure(&mut lab())
        .unwrap()
        .unwrap();
    let judged: Vec<Judgement> = found.measures.iter().map(Measure::judgement).collect();
    let expected = [
        Judgement::DoesNotHold,
        Judgement::Holds,
        Judgement::NotJudged,
    ];
    assert_eq!(judged, expected);
    assert!(found.measures[1].what.contains("16 signed bits"));
    assert_eq!(found.measures[1].ours, 127.0);
    assert!(found.reason_if_needed().unwrap().contains("127"));
}

/// Figure 10 of paper II has 2.3 fps without soft shadows and 1.75 with three passes.
#[test]
fn frame_rates_of_paper2_are_those_of_its_captions() {
    let claim = find("paper2-frame-rates").unwrap();
    assert!(
        claim
            .statement
            .contains("1.75 where it has 2.3 without soft shadows")
    );
}

/// Every claim can be measured, gives finite figures, and says what it counted.
#[test]
fn every_claim_is_measured_at_a_small_size() {
    let mut lab = lab();
    // Those that render a thousand shadows, large scenes, or build coverage textures, and
    // one that needs more pixels along an edge; Annen et al. have tests of their own.
    let dear = [
        "thesis",
        "paper2-tile-size",
        "paper3-bandwidth",
        "paper3-filtering",
        "paper3-table-build",
        "paper4-overlap",
        "paper4-splits",
        "paper5",
        "annen-table1",
        "annen-threefold",
        "annen-lights",
        "annen-brute-force",
        "cone-culling-time",
        "smoothies-aliasing",
        "tamura-lights-and-maps",
    ];
    let cheap = |c: &&Claim| !dear.iter().any(|d| c.id.starts_with(d));
    for claim in claims().filter(cheap) {
        let Some(found) = claim.measure(&mut lab).unwrap() else {
            continue;
        };
        assert!(
            !found.measures.is_empty() && !found.counted.is_empty(),
            "{}",
            claim.id
        );
        assert!(
            !found.reason.is_empty() && !found.scene.is_empty(),
            "{}",
            claim.id
        );
        for m in &found.measures {
            assert!(m.ours.is_finite(), "{}: {m:?}", claim.id);
        }
        let points = found
            .charts
            .iter()
            .flat_map(|c| &c.series)
            .flat_map(|s| &s.points);
        assert!(points.flatten().all(|v| v.is_finite()), "{}", claim.id);
    }
}

/// What cone culling and smoothies claim of themselves holds, but for times.
#[test]
fn claims_of_cones_and_smoothies_hold() {
    let settings = LabSettings {
        size: [128, 96],
        repeat: 1,
        ..LabSettings::default()
    };
    let mut lab = Lab::new(settings, None);
    for id in [
        "cone-culling-samples",
        "cone-culling-overlap",
        "cone-culling-umbra",
        "smoothies-umbra",
        "smoothies-aliasing",
    ] {
        let found = find(id).unwrap().measure(&mut lab).unwrap().unwrap();
        println!("{id}: {:?}", found.measures);
        assert_eq!(
            found.judgement(),
            Judgement::Holds,
            "{id}: {:?}",
            found.measures
        );
    }
}

// The tables, figures and claims of docs/validation.md, made of runs and of what was published.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { study } from './runs.mjs';
import { figure, fixed, grouped, interval, percent, probability, signed, withError, withInterval } from './format.mjs';
import {
  errorOfMean, errorOfSd, groupBy, jackknife, mean, Moments, partialEtaSquared,
} from './statistics.mjs';
import { readTables } from './toml.mjs';

const GROUP = ['individual-low', 'individual-high', 'common', 'joint'];
const BELIEFS = { group: ['common', 'joint'], individual: ['individual-low', 'individual-high'] };
const COMPOSITIONS = ['NNN', 'NNP', 'NPP', 'PPP'];
const OUTCOMES = ['periods', 'knowledge'];
const DIGITS = { periods: 2, knowledge: 3 };
const QUANTITIES = { mean: '', sd: 'sd of ' };
const POOLS = { group: 'group strategies', baseline: 'baseline' };
const DOMAINS = ['two-goals', 'cookie-crumb', 'colored-tiles', 'skateboard'];

const both = (key, value) => [`learner.N.${key}=${value}`, `learner.P.${key}=${value}`];
const COMMON = 'common - the others: common - individual-low - individual-high - joint';
const teamsOnly = 'record.level="team"';

export const COMMANDS = {
  version: ['version'],
  facts: ['inspect', 'item-delivery', '--show', 'demos', '--json'],
  large: study('studies/paper.toml', 'replicates=500'),
  small: study('studies/paper.toml', teamsOnly),
  'scale 0.9': study('studies/paper-uncalibrated.toml', 'replicates=500', ...both('ability_scale', 0.9), teamsOnly),
  'scale 1.0': study('studies/paper-uncalibrated.toml', 'replicates=500', ...both('ability_scale', 1.0), teamsOnly),
  'less known': study('studies/paper.toml', 'replicates=200', ...both('prior', '[]'), teamsOnly),
  'more known': study('studies/paper.toml', 'replicates=200', ...both('prior', '[{step=-1},{rubble=-1}]'), teamsOnly),
  ...Object.fromEntries(
    DOMAINS.map((domain) => [
      domain,
      study('studies/paper.toml', 'replicates=100', `domain="${domain}"`, teamsOnly),
    ]),
  ),
  'analysis, large': ['analyze', 'DIR(large)', '--json'],
  'analysis, small': ['analyze', 'DIR(small)', '--json'],
  ...Object.fromEntries(
    DOMAINS.map((domain) => [`analysis, ${domain}`, ['analyze', `DIR(${domain})`, '--contrast', COMMON, '--json']]),
  ),
  'findings, paired': ['power', 'studies/paper.toml', '--findings', 'studies/paper-targets.toml', '--json'],
  'findings, unpaired': [
    'power', 'studies/paper.toml', '--findings', 'studies/paper-targets.toml', '--set', 'design.pairing="none"', '--json',
  ],
};

const once = (make) => {
  const made = new Map();
  return (...key) => {
    const name = key.join('|');
    if (!made.has(name)) made.set(name, make(...key));
    return made.get(name);
  };
};

export function makeContent(runs, source) {
  const published = JSON.parse(readFileSync(join(source, 'tests/validation/published.json'), 'utf8'));
  const targets = readTables(readFileSync(join(source, 'studies/paper-targets.toml'), 'utf8'));
  const { paper, reference } = published;

  // Teams of a run for the jackknife: who was taught is (composition, replicate).
  const teamsOf = once((run, outcome) =>
    runs.table(run, 'teams').map((row) => ({
      stratum: row.composition, person: row.replicate, cell: row.strategy, value: row[outcome],
    })),
  );
  const pool = (cells, strategies, compositions = COMPOSITIONS) =>
    compositions
      .flatMap((composition) => strategies.map((strategy) => cells[`${composition} ${strategy}`]))
      .reduce((total, one) => total.plus(one));

  // {"mean group", "sd group", "mean baseline", "mean group/NNN", "mean common", ...: {value, se}}.
  const summary = once((run, outcome) =>
    jackknife(teamsOf(run, outcome), (cells) => {
      const estimates = {};
      const add = (name, moments) => Object.assign(estimates, { [`mean ${name}`]: moments.mean(), [`sd ${name}`]: moments.sd() });
      for (const [name, strategies] of [['group', GROUP], ['baseline', ['baseline']], ...GROUP.map((one) => [one, [one]])]) {
        add(name, pool(cells, strategies));
        for (const composition of COMPOSITIONS) add(`${name}/${composition}`, pool(cells, strategies, [composition]));
      }
      // How much composition moves the mean.
      for (const strategy of GROUP) {
        const means = COMPOSITIONS.map((composition) => cells[`${composition} ${strategy}`].mean());
        estimates[`range ${strategy}`] = Math.max(...means) - Math.min(...means);
      }
      const strategyMeans = GROUP.map((strategy) => estimates[`mean ${strategy}`]);
      estimates['strategy range'] = Math.max(...strategyMeans) - Math.min(...strategyMeans);
      const byBelief = (prefix, kind) => mean(BELIEFS[kind].map((strategy) => estimates[`${prefix} ${strategy}`]));
      estimates['range difference'] = byBelief('range', 'group') - byBelief('range', 'individual');
      estimates['gain of groups'] = estimates['mean group'] - estimates['mean baseline'];
      estimates['ratio of baseline'] = estimates['mean baseline'] / estimates['mean group'];
      return estimates;
    }),
  );

  const target = (quantity, statistic, teams) =>
    targets.target.find((one) => one.quantity === quantity && (one.statistic ?? 'mean') === statistic && one.teams === teams);
  // A published figure with its standard error.
  const publishedFigure = (quantity, statistic, teams) => {
    const n = paper.teams[teams];
    const deviation = target(quantity, 'sd', teams).value;
    const se = statistic === 'mean' ? deviation / Math.sqrt(n) : errorOfSd(deviation, n);
    return { value: target(quantity, statistic, teams).value, se };
  };
  const misfit = (quantity, statistic, teams, run = 'large') => {
    const here = summary(run, quantity)[`${statistic} ${teams}`];
    const there = publishedFigure(quantity, statistic, teams);
    return { value: (here.value - there.value) / there.se, se: here.se / there.se };
  };

  // A row of a table of `kith analyze`, by the text in its first column.
  const row = (run, finding, caption, name) => {
    const table = runs.finding(`analysis, ${run}`, finding).tables.find((one) => one.caption === caption);
    const found = table?.rows.find((one) => one[table.columns[0].field] === name);
    if (!found) throw new Error(`'${finding}' of kith analyze has no row '${name}' in a table '${caption}'`);
    return found;
  };
  const AS_PUBLISHED = 'Analysis of variance as published, all teams taken as independent (type II)';
  const term = (run, outcome, name) => row(run, outcome, AS_PUBLISHED, name);
  const termWithin = (outcome, name) => row('large', outcome, 'Tests of the fixed effects (type II, Satterthwaite)', name);
  // H1 and H2 of the large run, over all teams or at one composition.
  const PLANNED = 'Planned contrasts of strategy';
  const asEstimate = (found) => ({ ...found, value: found.difference, se: (found.upper_limit - found.lower_limit) / (2 * 1.96) });
  const belief = (outcome, teams, run = 'large') =>
    asEstimate(
      teams === 'all'
        ? row(run, `${outcome}-beliefs`, PLANNED, 'team beliefs - individual beliefs')
        : row(run, `${outcome}-beliefs`, `${PLANNED} at each level of composition`, teams),
    );
  // Teaching for the common belief against the other strategies, in another domain.
  const common = (run, outcome) => asEstimate(row(run, outcome, PLANNED, 'common - the others'));
  const spread = (outcome, teams) =>
    row('large', `${outcome}-variation`, 'Variance under team beliefs over that under individual beliefs', teams);
  const publishedF = (outcome, name) =>
    targets.finding.find((one) => one.effect === `${outcome}: ${name.replace(':', ' x ')}`);

  // Mean log area of a team's periods of a component, without the first.
  const areas = once(() => {
    const result = [];
    const rows = runs.table('large', 'periods').filter((row) => row.strategy !== 'baseline');
    for (const periods of groupBy(rows, (row) => `${row.strategy} ${row.composition} ${row.replicate}`).values()) {
      for (const [kc, shown] of groupBy(periods, (row) => row.kc)) {
        if (shown.length < 2) continue;
        const { strategy, composition, replicate } = shown[0];
        result.push({ strategy, kc, people: `${composition} ${replicate}`, value: mean(shown.slice(1).map((row) => Math.log(row.area_sr))) });
      }
    }
    return result;
  });
  const areaMean = (strategy, kc) => {
    const values = areas().filter((row) => row.strategy === strategy && row.kc === kc).map((row) => row.value);
    return { value: mean(values), se: errorOfMean(values) };
  };
  const areaDifference = (strategy, kc) => {
    const pairs = groupBy(areas().filter((row) => row.kc === kc && [strategy, 'joint'].includes(row.strategy)), (row) => row.people);
    const values = [...pairs.values()].filter((rows) => rows.length === 2).map((rows) => {
      const of = (name) => rows.find((row) => row.strategy === name).value;
      return of('joint') - of(strategy);
    });
    return { value: mean(values), se: errorOfMean(values) };
  };

  const learned = (type, column) => {
    const values = runs.table('large', 'learners').filter((row) => row.strategy === 'baseline' && row.type === type).map((row) => row[column]);
    return { value: mean(values), se: errorOfMean(values) };
  };

  const factsHere = once(() => {
    const facts = runs.json('facts');
    const states = groupBy(facts.demos, (demo) => demo.start.mdp);
    const counts = [0, 1].map((charger) => [...new Set([...states].filter(([mdp]) => mdp % 2 === charger).map(([, demos]) => demos.length))].join(' or '));
    const lengths = facts.demos.map((demo) => demo.actions.length);
    return {
      'worlds, demonstration candidates': `${facts.mdps}, ${grouped(facts.demonstrations)}`,
      'states without, with a charger': counts.join(', '),
      "lengths of the robot's paths": `${Math.min(...lengths)} .. ${Math.max(...lengths)}`,
      'starts with more than one optimal path': grouped(facts.demos.filter((demo) => !demo.unique).length),
      'minimal BEC': facts.bec.constraints.map((normal) => `(${normal})`).join(', '),
      'its solid angle with the prior, sr': fixed(facts.bec.area_sr, 7),
      'areas of the knowledge components, sr': facts.knowledge_components.map(({ area_sr: area }) => fixed(area, area > 0.1 ? 6 : 7)).join(', '),
      'mask counters': facts.mask_counters.map(grouped).join(', '),
      'coverage sets: vertices, mean, largest': `${grouped(facts.coverage.vertices)}, ${fixed(facts.coverage.mean, 2)}, ${facts.coverage.max}`,
    };
  });

  const tables = {
    facts: () => ({
      columns: ['fact', 'value'],
      rows: Object.keys(reference.facts).map((name) => [name, { text: factsHere()[name] ?? 'missing' }]),
    }),

    'published-figures': () => ({
      columns: ['figure', 'published', 'its standard error', 'kith', 'off by, in published standard errors'],
      rows: ['mean', 'sd'].flatMap((statistic) =>
        OUTCOMES.flatMap((outcome) =>
          Object.entries(POOLS).map(([teams, label]) => {
            const there = publishedFigure(outcome, statistic, teams);
            const digits = DIGITS[outcome];
            return [
              `${QUANTITIES[statistic]}${outcome}, ${label}`,
              fixed(there.value, 2),
              fixed(there.se, outcome === 'periods' ? 2 : 4),
              withError(summary('large', outcome)[`${statistic} ${teams}`], digits + 1),
              figure(misfit(outcome, statistic, teams), 1, signed),
            ];
          }),
        ),
      ),
    }),

    effects: () => ({
      columns: ['effect', 'published F', 'its partial eta squared', 'kith: partial eta squared', 'p', 'p, people as random intercepts', 'p (15)'],
      rows: OUTCOMES.flatMap((outcome) =>
        ['strategy', 'composition', 'strategy:composition'].map((name) => {
          const there = publishedF(outcome, name);
          const eta = there?.f ? partialEtaSquared(there.f, ...there.df) : null;
          const large = term('large', outcome, name);
          const small = term('small', outcome, name);
          return [
            `${outcome}: ${name.replace(':', ' x ')}`,
            there?.f ? fixed(there.f, 2) : 'n.s.',
            eta ? `${fixed(eta.value, 3)} ${interval(eta.low, eta.high, 3)}` : '',
            withInterval(large.partial_eta_squared, large.lower_limit, large.upper_limit, 4),
            { text: probability(large.p_value), value: large.p_value },
            { text: probability(termWithin(outcome, name).p_value), value: termWithin(outcome, name).p_value },
            { text: probability(small.p_value), value: small.p_value },
          ];
        }),
      ),
    }),

    hypotheses: () => ({
      columns: ['outcome', 'group beliefs - individual beliefs', '95 % interval', 'p'],
      rows: OUTCOMES.map((outcome) => {
        const one = belief(outcome, 'all');
        const digits = DIGITS[outcome] + 1;
        return [
          outcome,
          withError(one, digits, signed),
          { text: interval(one.lower_limit, one.upper_limit, digits), value: one.lower_limit, se: one.se },
          { text: probability(one.p_value), value: one.p_value },
        ];
      }),
    }),

    'variance-ratios': () => ({
      columns: ['outcome', 'variance ratio, 95 % interval', 'p', 'p, Brown-Forsythe'],
      rows: OUTCOMES.map((outcome) => {
        const one = spread(outcome, 'all');
        return [
          outcome,
          withInterval(one.variance_ratio, one.lower_limit, one.upper_limit, 3),
          { text: probability(one.p_value_jackknife), value: one.p_value_jackknife },
          { text: probability(one.p_value_brown_forsythe), value: one.p_value_brown_forsythe },
        ];
      }),
    }),

    power: () => {
      const paired = runs.json('findings, paired').replication;
      const share = ({ significant, low, high }, { studies }) => ({
        text: `${percent(significant / studies, 1)} (${percent(low).replace(' %', '')} .. ${percent(high).replace(' %', '')})`,
        value: (100 * significant) / studies,
        se: (100 * (high - low)) / (2 * 1.96),
      });
      return {
        columns: ['finding', 'published', 'significant here', 'power by F'],
        rows: paired.findings.map((finding) => [
          finding.effect,
          `${finding.published_significant ? `p < ${String(finding.alpha).replace(/^0/, '')}` : 'n.s.'}${finding.published_f ? `, F = ${fixed(finding.published_f, 2)}` : ''}`,
          share(finding, paired),
          finding.analytic_power === null ? '' : { text: fixed(finding.analytic_power, 2), value: finding.analytic_power },
        ]),
      };
    },
  };

  const large = (outcome, name) => summary('large', outcome)[name];
  const eta = (outcome, name) => ({ value: term('large', outcome, name).partial_eta_squared, se: (term('large', outcome, name).upper_limit - term('large', outcome, name).lower_limit) / (2 * 1.645) });
  const publishedMean = (outcome, teams) => publishedFigure(outcome, 'mean', teams).value;
  const figures = {
    version: () => ({ text: runs.run('version').split(' ')[1] }),
    'misfit.knowledge.group': () => figure(misfit('knowledge', 'mean', 'group'), 1, signed),
    'misfit.knowledge.baseline': () => figure(misfit('knowledge', 'mean', 'baseline'), 1, signed),
    'misfit.periods.group': () => figure(misfit('periods', 'mean', 'group'), 1, signed),
    'misfit.periods.baseline': () => figure(misfit('periods', 'mean', 'baseline'), 1, signed),
    'ratio': () => figure(large('periods', 'ratio of baseline'), 2),
    'ratio.published': () => fixed(publishedMean('periods', 'baseline') / publishedMean('periods', 'group'), 2),
    'gap': () => figure(large('knowledge', 'gain of groups'), 3),
    'gap.published': () => fixed(publishedMean('knowledge', 'group') - publishedMean('knowledge', 'baseline'), 2),
    'lessons.group': () => figure(large('periods', 'mean group'), 2),
    'lessons.alone': () => figure({ value: large('periods', 'mean baseline').value / 3, se: large('periods', 'mean baseline').se / 3 }, 2),
    'sd.knowledge': () => figure(large('knowledge', 'sd group'), 3),
    'sd.knowledge.published': () => fixed(publishedFigure('knowledge', 'sd', 'group').value, 2),
    'eta.composition': () => figure(eta('periods', 'composition'), 2),
    'eta.composition.published': () => fixed(partialEtaSquared(publishedF('periods', 'composition').f, 3, 224).value, 3),
    'strategy.periods.range': () => withError(large('periods', 'strategy range'), 2),
    'strategy.knowledge.range': () => withError(large('knowledge', 'strategy range'), 3),
    'range.difference': () => withError(large('periods', 'range difference'), 2, signed),
    'agreement.paired': () => ({ text: fixed(runs.json('findings, paired').replication.mean_agreement, 1), value: runs.json('findings, paired').replication.mean_agreement }),
    'agreement.unpaired': () => ({ text: fixed(runs.json('findings, unpaired').replication.mean_agreement, 1), value: runs.json('findings, unpaired').replication.mean_agreement }),
    'reference.knowledge': () => {
      const gaps = ['0.9', '1.0'].flatMap((scale) =>
        Object.keys(POOLS).map((teams) => reference.study[scale][`knowledge ${teams}`][0] - summary(`scale ${scale}`, 'knowledge')[`mean ${teams}`].value),
      );
      const text = [Math.min(...gaps), Math.max(...gaps)].map((gap) => fixed(gap, 3));
      return { text: text[0] === text[1] ? text[0] : `${text[0]} to ${text[1]}`, value: mean(gaps), se: summary('scale 0.9', 'knowledge')['mean group'].se };
    },
  };

  const orderOf = (value) => GROUP.map((strategy) => [strategy, value(strategy)]).sort((a, b) => a[1] - b[1]).map(([strategy]) => strategy);
  const insignificant = (outcome, name) => termWithin(outcome, name).p_value > 0.05;
  const claims = {
    'facts-agree': () => Object.entries(reference.facts).every(([name, value]) => factsHere()[name] === value),
    'reference-periods-agree': () =>
      ['0.9', '1.0'].every((scale) =>
        Object.entries({ group: 0.1, baseline: 0.3 }).every(([teams, bound]) =>
          Math.abs(summary(`scale ${scale}`, 'periods')[`mean ${teams}`].value - reference.study[scale][`periods ${teams}`][0]) < bound,
        ),
      ),
    'common-conveys-least': () =>
      orderOf((strategy) => summary('large', 'area_sr')[`mean ${strategy}`].value)[3] === 'common' &&
      [1, 2].every((kc) => orderOf((strategy) => areaMean(strategy, kc).value)[3] === 'common'),
    'joint-conveys-most': () =>
      orderOf((strategy) => summary('large', 'area_sr')[`mean ${strategy}`].value)[0] === 'joint' && orderOf((strategy) => areaMean(strategy, 2).value)[0] === 'joint',
    'low-as-informative-in-1': () => Math.abs(areaDifference('individual-low', 1).value) < 2 * areaDifference('individual-low', 1).se,
    'no-interaction': () => OUTCOMES.every((outcome) => insignificant(outcome, 'strategy:composition')),
    'strategy-hardly-matters': () =>
      large('periods', 'strategy range').value < 0.2 &&
      large('knowledge', 'strategy range').value < 0.02 &&
      OUTCOMES.every((outcome) => term('large', outcome, 'strategy').upper_limit < 0.01 && term('small', outcome, 'strategy').p_value > 0.05),
    'high-conveys-most-in-3': () => orderOf((strategy) => areaMean(strategy, 3).value)[0] === 'individual-high',
    'no-difference-of-beliefs': () => OUTCOMES.every((outcome) => belief(outcome, 'all').p_value > 0.05),
    'differences-are-small': () =>
      OUTCOMES.every((outcome) =>
        ['all', ...COMPOSITIONS].every((teams) => {
          const { lower_limit: low, upper_limit: high } = belief(outcome, teams);
          return Math.max(-low, high) < { periods: 0.25, knowledge: 0.02 }[outcome];
        }),
      ),
    'variances-agree-on-periods': () => spread('periods', 'all').p_value_jackknife > 0.05,
    'knowledge-varies-most-under-common': () =>
      spread('knowledge', 'all').lower_limit > 1 &&
      orderOf((strategy) => large('knowledge', `sd ${strategy}`).value)[3] === 'common',
    'composition-too-strong': () => {
      const { f, df } = publishedF('periods', 'composition');
      return term('large', 'periods', 'composition').lower_limit > partialEtaSquared(f, ...df).high;
    },
    'confirm-gain-smaller': () => {
      const ratio = learned('N', 'confirm_gain').value / (paper.gains.N.confirm_gain * Math.sqrt(2 / Math.PI));
      return ratio > 0.62 && ratio < 0.71;
    },
    'means-reproduced-or-not': () =>
      [['periods', 'mean', 'group'], ['periods', 'sd', 'baseline'], ['knowledge', 'sd', 'baseline']].every((one) => Math.abs(misfit(...one).value) < 2) &&
      misfit('knowledge', 'mean', 'group').value > 2 && misfit('knowledge', 'mean', 'baseline').value < -2 &&
      misfit('periods', 'mean', 'baseline').value < -2,
    'within-tolerances': () =>
      OUTCOMES.every((outcome) =>
        Object.keys(POOLS).every((teams) =>
          ['mean', 'sd'].every((statistic) => {
            const { value, tolerance, within_factor: factor } = target(outcome, statistic, teams);
            const here = summary('large', outcome)[`${statistic} ${teams}`].value;
            return factor ? Math.abs(Math.log(here / value)) <= Math.log(factor) : Math.abs(here - value) <= tolerance;
          }),
        ),
      ),
    'ranges-agree': () => Math.abs(large('periods', 'range difference').value) < 1.96 * large('periods', 'range difference').se,
    'all-complete': () => runs.table('large', 'teams').every((row) => row.status === 'complete'),
    'powers-agree': () =>
      runs.json('findings, paired').replication.findings.every(
        ({ analytic_power: byF, imposed_power: imposed }) => byF === null || imposed === null || Math.abs(byF - imposed.power) < 0.05,
      ),
    'never-all-findings': () => runs.json('findings, paired').replication.all_agree === 0 && runs.json('findings, unpaired').replication.all_agree === 0,
    exceptions: () =>
      ['paired', 'unpaired'].every((pairing) => {
        const { studies, findings } = runs.json(`findings, ${pairing}`).replication;
        const unlike = findings.filter((one) => one.significant > studies / 2 !== one.published_significant).map((one) => one.effect);
        return unlike.join() === ['knowledge: strategy x composition', 'knowledge: strategy in NNN', 'knowledge: strategy in PPP', 'area_sr: strategy', 'knowledge: group - baseline'].join();
      }),
    'common-teaches-less-elsewhere': () =>
      DOMAINS.every((domain) => common(domain, 'knowledge').value < 0) &&
      DOMAINS.filter((domain) => common(domain, 'knowledge').p_value < 0.05).join() === 'two-goals,cookie-crumb,skateboard',
    'periods-agree-elsewhere': () =>
      DOMAINS.every((domain) => common(domain, 'periods').p_value > 0.05 && belief('periods', 'all', domain).p_value > 0.05),
    'prior-matters-little': () =>
      ['less known', 'more known'].every((run) => Math.abs(summary(run, 'knowledge')['mean group'].value - large('knowledge', 'mean group').value) < 0.02),
  };
  // "sd of knowledge, group": the figure of the large run.
  const named = (name) => {
    const [, deviation, outcome, teams] = /^(sd of )?(\w+), (\w+)$/.exec(name);
    return summary('large', outcome)[`${deviation ? 'sd' : 'mean'} ${teams}`].value;
  };
  const before = (outcome, statistic, teams) => summary('scale 1.0', outcome)[`${statistic} ${teams}`].value;
  const least = ({ value, tolerance, within_factor: factor }) => (factor ? value / factor : value - tolerance);
  const quotes = {
    'studies/paper.toml': () => [
      `take ${fixed(before('periods', 'mean', 'baseline'), 1)} periods (at least ${fixed(least(target('periods', 'mean', 'baseline')), 2)} ` +
        `are asked for), and the standard deviation of the groups' knowledge is ${fixed(before('knowledge', 'sd', 'group'), 3)} ` +
        `(at least ${fixed(least(target('knowledge', 'sd', 'group')), 3)}).`,
      `Here they are ${fixed(named('periods, baseline'), 1)} and ${fixed(named('sd of knowledge, group'), 3)}, and the groups take ` +
        `${fixed(named('periods, group'), 2)} periods (published: ${target('periods', 'mean', 'group').value}).`,
    ],
  };
  return { tables, figures, claims, quotes };
}

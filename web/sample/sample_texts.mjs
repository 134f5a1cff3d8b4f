// Synthetic findings, methods and commands in the shape that kith writes them.
function resultTable(caption, columns, rows) {
  return {
    caption,
    columns: columns.map(([field, name, kind]) => ({ field, name, kind })),
    rows: rows.map((row) => Object.fromEntries(columns.map(([field], i) => [field, row[i]]))),
  };
}

export function sampleTexts() {
  return {
    findings: [
      {
        id: 'periods',
        title: 'Periods: strategy x composition',
        question: 'Do strategy or composition change how many periods a team needs?',
        sentence:
          'A two-way analysis of variance on 240 synthetic teams found an effect of composition, F(3, 224) = 4.67, p = 0.003, and none of strategy, F(3, 224) = 0.42, p = 0.74.',
        warnings: ["The variances of the cells differ (Levene p = 0.02); Welch's test agrees."],
        tables: [
          resultTable(
            'Analysis of variance (type II)',
            [
              ['term', 'term', 'text'],
              ['df', 'df', 'count'],
              ['sum_of_squares', 'sum of squares', 'number'],
              ['f', 'F', 'number'],
              ['p_value', 'p-value', 'p'],
              ['partial_eta_squared', 'partial eta squared', 'fraction'],
            ],
            [
              ['strategy', 3, 2.9, 0.42, 0.7388, 0.0056],
              ['composition', 3, 32.21, 4.67, 0.00349, 0.0588],
              ['strategy:composition', 9, 14.2, 0.6862, 0.7209, 0.0268],
              ['residuals', 224, 515.1],
            ],
          ),
          resultTable(
            'Pairs of composition (Tukey)',
            [
              ['pair', 'pair', 'text'],
              ['difference', 'difference', 'number'],
              ['lower_limit', 'lower limit', 'number'],
              ['upper_limit', 'upper limit', 'number'],
              ['p_value_adjusted', 'p-value, adjusted', 'p'],
            ],
            [
              ['NNN - PPP', 1.8, 1.1, 2.5, 0.0000021],
              ['NNP - PPP', 1.2, 0.5, 1.9, 0.0003],
            ],
          ),
        ],
      },
      {
        id: 'knowledge',
        title: 'Knowledge: strategy x composition',
        question: 'Do strategy or composition change what people know at the end?',
        sentence: 'Composition mattered and strategy did not.',
        warnings: [],
        tables: [],
      },
    ],
    methods: {
      paragraph:
        'We simulated 300 teams of three (5 strategies x 4 compositions x 15 replicates) with kith 0.0.0. This paragraph is part of a synthetic sample.',
      references: [
        {
          key: 'jayaraman2024',
          text: 'Jayaraman, S., Simmons, R., Steinfeld, A., & Admoni, H. (2024). A sample entry; see docs/references.bib for the real one.',
          bibtex: '@article{jayaraman2024,\n  author = {Jayaraman, Suresh Kumaar and others},\n  year   = {2024}\n}',
        },
      ],
    },
    reproduce: {
      command: 'kith study study.toml -o DIR',
      version: 'kith 0.0.0 (sample)',
      study_toml:
        'schema = "kith.study/1"\nid     = "sample"\ntitle  = "Group strategies and team compositions (synthetic sample), a long line that has to scroll in its own box"\n',
      domain_toml: 'schema = "kith.domain/1"\nid     = "item-delivery"\n',
      hashes: { 'inputs/study.toml': 'ab'.repeat(32), 'tables/teams.csv': 'cd'.repeat(32) },
    },
  };
}
